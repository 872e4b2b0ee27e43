from setuptools import setup
from setuptools.command.build_py import build_py


class BuildPy(build_py):
    """Puts the interface for compiled systems, which the core is built from, beside the package's modules as well."""

    def run(self):
        super().run()
        if not self.editable_mode:      # there zerodrift.get_include() finds it where it is
            self.copy_tree("csrc/include", f"{self.build_lib}/zerodrift/include")


setup(
    cffi_modules=["python/build_core.py:ffibuilder"],
    cmdclass={"build_py": BuildPy},
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
