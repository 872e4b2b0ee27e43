from setuptools import setup

setup(
    cffi_modules=["python/build_core.py:ffibuilder"],
    options={"bdist_wheel": {"py_limited_api": "cp311"}},
)
