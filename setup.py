import logging
import os
import tarfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from setuptools import setup
from setuptools.command.build_ext import build_ext
from setuptools.command.build_py import build_py
from setuptools.command.sdist import sdist


class BuildExtension(build_ext):
    """Compiles the files of the core side by side, in one compiler process for each processor of this process.

    The option `--parallel` of `build_ext` or the variable `MAX_JOBS` sets another number. Commands, flags and the order of the
    objects when linked are those of the compiler class, of any platform, whose `compile` is called for one file at a time.
    """

    def build_extensions(self):
        compile_all = self.compiler.compile

        def compile_in_parallel(sources, **options):
            largest_first = sorted(sources, key=os.path.getsize, reverse=True)      # so that no long one is left at the end
            objects = dict.fromkeys(sources)
            with ThreadPoolExecutor(self.processes()) as pool:
                for count, (source, compiled) in enumerate(zip(largest_first, pool.map(
                        lambda source: compile_all([source], **options), largest_first), strict=True), start=1):
                    objects[source], = compiled
                    self.announce(f"compiled {count} of {len(sources)} files: {source}", level=logging.INFO)
            return list(objects.values())

        if not getattr(self.compiler, "initialized", True):
            self.compiler.initialize()      # MSVC finds its programs once, before the threads need them
        self.compiler.compile = compile_in_parallel
        super().build_extensions()

    def processes(self) -> int:
        """Number of compiler processes at a time, at least one."""
        available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
        return max(1, int(self.parallel or os.environ.get("MAX_JOBS") or available))


class BuildPy(build_py):
    """Puts the interface for compiled systems, which the core is built from, beside the package's modules as well."""

    def run(self):
        super().run()
        if not self.editable_mode:      # there zerodrift.get_include() finds it where it is
            self.copy_tree("csrc/include", f"{self.build_lib}/zerodrift/include")
            for path in sorted(Path("csrc").rglob("*.[ch]")):      # of which zerodrift.c_source() takes files
                if not {"batch", "closed_form", "python"} & set(path.parts):
                    self.mkpath(str(Path(self.build_lib, "zerodrift", path).parent))
                    self.copy_file(str(path), str(Path(self.build_lib, "zerodrift", path)))


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
    cmdclass={"build_ext": BuildExtension, "build_py": BuildPy, "sdist": SourceDistribution},
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
