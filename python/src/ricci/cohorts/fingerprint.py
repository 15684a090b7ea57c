"""The text that identifies a job: its name, and a digest of its code and of everything of the user's that it uses.

Two jobs with the same text may share a folder of rows. A change of the code, of a constant, a default, a variable that the job closes over
or reads from its module, or of a function of the user's that it calls, is another text. Installed packages count by their names alone.
"""

from __future__ import annotations

import dis
import hashlib
import sys
import sysconfig
import types
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ricci._call import Passed

__all__ = ["changed", "digest", "name_of", "spelled"]

# Folders of modules that are taken to stay as they are.
_INSTALLED = {Path(sysconfig.get_path(name)).resolve() for name in ("stdlib", "platstdlib", "purelib", "platlib")}


def name_of(job: Any) -> str:
    """The name by which a user knows a job."""
    if isinstance(job, partial):
        return f"partial of {name_of(job.func)}"
    name = getattr(job, "__qualname__", None)
    return f"{job.__module__}.{name}" if name else f"{type(job).__module__}.{type(job).__qualname__}"


def digest(value: Any) -> str:
    """Sixteen hexadecimal digits that are others for another value; the same in every process."""
    found = hashlib.sha256()
    found.update(_Walk().of(value).encode("utf-8", "surrogatepass"))
    return found.hexdigest()[:16]


def _is_installed(module: str) -> bool:
    """True of a module of the standard library, of an installed package, or of this one."""
    if module.partition(".")[0] in ("ricci", "builtins") or module in sys.builtin_module_names:
        return True
    file = getattr(sys.modules.get(module), "__file__", None)
    if file is None or module == "__main__":
        return False
    parents = Path(file).resolve().parents
    return any(folder in parents for folder in _INSTALLED)


class _Walk:
    """One walk through a value and what it leads to, which ends where it comes to the same thing again."""

    def __init__(self) -> None:
        # Functions, classes and modules that have been spelled, by their identities; and the other values that the walk is inside.
        self._known: dict[int, int] = {}
        self._inside: list[int] = []

    def of(self, value: Any) -> str:
        """The text of a value."""
        if value is None or isinstance(value, bool | int | float | complex | str | bytes | types.EllipsisType):
            return f"{type(value).__name__} {value!r}"
        if isinstance(value, types.FunctionType | type | types.ModuleType):
            if id(value) in self._known:
                return f"again {self._known[id(value)]}"
            self._known[id(value)] = len(self._known)
            return f"({self._parts(value)})"
        if id(value) in self._inside:
            return f"up {self._inside.index(id(value))}"
        self._inside.append(id(value))
        try:
            return f"({type(value).__qualname__} {self._parts(value)})"
        finally:
            self._inside.pop()

    def _all(self, values: Any) -> str:
        return ", ".join(self.of(value) for value in values)

    def _parts(self, value: Any) -> str:
        """The parts of a value that is not simple."""
        if isinstance(value, np.ndarray) and value.dtype != object:
            return f"{value.dtype} {value.shape} {hashlib.sha256(np.ascontiguousarray(value).tobytes()).hexdigest()}"
        if isinstance(value, tuple | list):
            return self._all(value)
        if isinstance(value, set | frozenset):
            return ", ".join(sorted(digest(entry) for entry in value))
        if type(value) is dict or isinstance(value, types.MappingProxyType):
            return ", ".join(f"{self.of(key)}: {self.of(entry)}" for key, entry in value.items())
        if isinstance(value, types.ModuleType):
            return self._module(value)
        if isinstance(value, types.CodeType):
            return self._code(value, None)
        if isinstance(value, types.FunctionType):
            return self._function(value)
        if isinstance(value, type):
            return self._class(value)
        if isinstance(value, types.MethodType):
            return self._all((value.__func__, value.__self__))
        if isinstance(value, partial):
            return self._all((value.func, value.args, value.keywords))
        if isinstance(value, classmethod | staticmethod):
            return self.of(value.__func__)
        if isinstance(value, property):
            return self._all((value.fget, value.fset, value.fdel))
        if isinstance(getattr(value, "__wrapped__", None), types.FunctionType):
            return self.of(value.__wrapped__)
        return self._object(value)

    def _module(self, module: types.ModuleType) -> str:
        """A module of the user's by the text of its file, with the user's modules that it imports from."""
        file = getattr(module, "__file__", None)
        if _is_installed(module.__name__) or file is None:
            return module.__name__
        values = [vars(module)[name] for name in sorted(vars(module))]
        origins = [value if isinstance(value, types.ModuleType) else _origin(value) for value in values]
        others = [other for other in origins if other is not None and not _is_installed(other.__name__)]
        return f"{module.__name__} {hashlib.sha256(Path(file).read_bytes()).hexdigest()} {self._all(others)}"

    def _code(self, code: types.CodeType, doc: str | None) -> str:
        """The instructions of a function with what they name; neither places in a file nor the text that documents it."""
        constants = [constant for constant in code.co_consts if doc is None or constant != doc]
        return self._all([code.co_code, constants, code.co_names, code.co_varnames, code.co_freevars, code.co_cellvars, code.co_flags])

    def _function(self, function: types.FunctionType) -> str:
        """A function of the user's with the values that it reads from around it; one of a package by its name."""
        name = f"{function.__module__}.{function.__qualname__}"
        if _is_installed(function.__module__ or ""):
            return name
        cells = [_contents(cell) for cell in function.__closure__ or ()]
        globs = {key: function.__globals__[key] for key in sorted(_globals_of(function.__code__)) if key in function.__globals__}
        return ", ".join(
            [
                name,
                self._code(function.__code__, function.__doc__),
                self._all((function.__defaults__, function.__kwdefaults__, cells, globs)),
            ]
        )

    def _class(self, kind: type) -> str:
        """A class of the user's with its members; one of a package by its name."""
        name = f"{kind.__module__}.{kind.__qualname__}"
        if _is_installed(kind.__module__):
            return name
        skipped = ("__dict__", "__weakref__", "__doc__", "__firstlineno__", "__static_attributes__")
        members = {key: value for key, value in vars(kind).items() if key not in skipped}
        return ", ".join([name, self._all(kind.__bases__), self.of(members)])

    def _object(self, value: Any) -> str:
        """An object by its class and the state that pickle would take; by its class alone where there is none, as of locks."""
        kind = self.of(type(value))
        try:
            state = value.__reduce_ex__(4)
        except Exception:
            # What the library holds is told apart by its figures, and a metric by its variables.
            return f"{kind} {getattr(value, 'summary', '')} {self.of(getattr(value, 'u', None))}" if isinstance(value, Passed) else kind
        if isinstance(state, str):
            return f"{kind} {state}"
        made, arguments, *rest = state
        return ", ".join([kind, self.of(made), self.of(arguments), *(self.of(_listed(part)) for part in rest)])


def _origin(value: Any) -> types.ModuleType | None:
    """The module in which a function or class was defined."""
    name = getattr(value, "__module__", None)
    return sys.modules.get(name) if isinstance(name, str) else None


def _listed(part: Any) -> Any:
    """The entries of an iterator; anything else as it is."""
    return list(part) if hasattr(part, "__next__") else part


def _contents(cell: types.CellType) -> Any:
    """What a variable around a function has, nothing if it has not been set."""
    try:
        return cell.cell_contents
    except ValueError:
        return None


def _globals_of(code: types.CodeType) -> set[str]:
    """The global names that a function, or a function inside it, reads."""
    found = {at.argval for at in dis.get_instructions(code) if at.opname in ("LOAD_GLOBAL", "LOAD_NAME")}
    for constant in code.co_consts:
        if isinstance(constant, types.CodeType):
            found |= _globals_of(constant)
    return found


def spelled(value: Any) -> Any:
    """The text of an option that JSON has no type for: arrays as lists, anything else by its name and its digest."""
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else f"{name_of(value)} #{digest(value)}"


def changed(known: str, own: str) -> str:
    """What a folder's note and a job's own text say about each other, for a message; empty where the jobs have different names."""
    names = [" ".join(word for word in text.split() if not word.startswith("#")) for text in (known, own)]
    return "its code, or what it uses, has changed since" if names[0] == names[1] else ""
