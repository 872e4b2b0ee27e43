from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist


class BuildPy(build_py):
    """Puts the interface for compiled systems, which the core is built from, beside the package's modules as well."""

    def run(self):
        super().run()
        if not self.editable_mode:      # there zerodrift.get_include() finds it where it is
            self.copy_tree("csrc/include", f"{self.build_lib}/zerodrift/include")


class SourceDistribution(sdist):
    """Takes what MANIFEST.in says, and not what an earlier list of files says as well, which setuptools would add to it."""

    def run(self):
        for earlier in Path("python").glob("*.egg-info/SOURCES.txt"):
            earlier.unlink()
        super().run()


setup(
    cffi_modules=["python/build_core.py:ffibuilder"],
    cmdclass={"build_py": BuildPy, "sdist": SourceDistribution},
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
