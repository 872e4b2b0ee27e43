"""The compiled core, as CFFI makes it."""

from typing import Any

ffi: Any
lib: Any
