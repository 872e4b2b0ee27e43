import tarfile
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

    def make_archive(self, base_name, format, root_dir=None, base_dir=None, owner=None, group=None):
        """The archive says neither who made it nor parts of seconds, of which setuptools writes 28 kB."""
        if format != "gztar":
            return super().make_archive(base_name, format, root_dir, base_dir, owner, group)
        self.mkpath(str(Path(base_name).parent))
        with tarfile.open(f"{base_name}.tar.gz", "w:gz") as archive:
            archive.add(base_dir, filter=impersonal)
        return archive.name


def impersonal(member: tarfile.TarInfo) -> tarfile.TarInfo:
    """A member of an archive, changed in a whole second and by nobody."""
    member.mtime, member.uid, member.gid, member.uname, member.gname = int(member.mtime), 0, 0, "", ""
    return member


setup(
    cffi_modules=["python/build_core.py:ffibuilder"],
    cmdclass={"build_py": BuildPy, "sdist": SourceDistribution},
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
