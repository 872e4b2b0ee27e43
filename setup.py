import json
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
    """Leaves out what notebooks have printed and drawn, which is larger than all the rest; to run them brings it back."""

    def make_release_tree(self, base_dir, files):
        super().make_release_tree(base_dir, files)
        for path in Path(base_dir).rglob("*.ipynb"):
            notebook = json.loads(path.read_text(encoding="utf-8"))
            for cell in notebook["cells"]:
                if cell["cell_type"] == "code":
                    cell.update(outputs=[], execution_count=None)
            path.unlink()       # it may be a link to the file that it was made from
            path.write_text(json.dumps(notebook, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


setup(
    cffi_modules=["python/build_core.py:ffibuilder"],
    cmdclass={"build_py": BuildPy, "sdist": SourceDistribution},
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
