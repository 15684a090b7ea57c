"""The declarations of the headers, as cffi reads them; made when the wheel is built."""

from typing import Any

ffi: Any
