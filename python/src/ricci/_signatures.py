"""Functions with options: their names are looked at, and `help` shows what each option means."""

from __future__ import annotations

import difflib
import inspect
import re
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar, cast

from ricci.errors import ArgumentTypeError

__all__ = ["picked", "takes"]

Function = TypeVar("Function", bound=Callable[..., Any])
Options = TypeVar("Options")


def picked(arguments: Mapping[str, Any], kind: type[Options]) -> Options:
    """The options of this kind among the arguments of a call, but for those that are None, which leaves an option out.

    Parameters
    ----------
    arguments : Mapping
        The arguments by name: ``locals()`` at the beginning of a function.
    kind : type
        A `TypedDict` of options.
    """
    return cast(Options, {name: arguments[name] for name in kind.__annotations__ if arguments[name] is not None})


def takes(kind: type, continued: type | None = None) -> Callable[[Function], Function]:
    """A decorator of a function that has the options of this kind as keyword arguments.

    The function refuses other names in words, and its documentation gets the descriptions of the options.

    Parameters
    ----------
    kind : type
        A `TypedDict` of options.
    continued : type | None
        The one that it inherits from, whose options are described there.
    """

    def decorate(function: Function) -> Function:
        known = [name for name, given in inspect.signature(function).parameters.items() if given.kind is not given.POSITIONAL_ONLY]

        @wraps(function)
        def checked(*arguments: Any, **given: Any) -> Any:
            for name in given:
                if name not in known:
                    near = difflib.get_close_matches(name, known, 1)
                    meant = f"; did you mean {near[0]!r}?" if near else ""
                    options = ", ".join(sorted(set(known) - {"self", "cls"}))
                    raise ArgumentTypeError(f"there is no option {name!r} of {function.__name__}; there are {options}{meant}")
            return function(*arguments, **given)

        told = "\n".join(_descriptions(part) for part in (continued, kind) if part is not None)
        checked.__doc__ = _with_options(inspect.getdoc(function) or "", told)
        return checked  # type: ignore[return-value]

    return decorate


def _section(text: str, title: str) -> tuple[int, int]:
    """Where the body of a section of a documentation begins and ends; both where it would be inserted if there is none."""
    found = re.search(rf"^{title}\n-+\n", text, re.MULTILINE)
    if found is None:
        # Behind the parameters, or else behind the text, comes the next section.
        following = re.search(r"^\w+\n-{3,}\n", text, re.MULTILINE)
        at = following.start() if following else len(text)
        return at, at
    following = re.search(r"^\w+\n-{3,}\n", text[found.end() :], re.MULTILINE)
    return found.end(), found.end() + following.start() if following else len(text)


def _descriptions(kind: type) -> str:
    """The descriptions of the options of a kind, but for those of a kind that it continues."""
    told = inspect.getdoc(kind) or ""
    start, end = _section(told, "Attributes")
    return told[start:end].strip("\n")


def _with_options(text: str, options: str) -> str:
    """The documentation of a function with the descriptions of its options behind those of its other parameters."""
    start, end = _section(text, "Parameters")
    if start == end:
        return f"{text[:start].rstrip()}\n\nParameters\n----------\n{options}\n\n{text[end:]}".rstrip() + "\n"
    return f"{text[:end].rstrip()}\n{options}\n\n{text[end:]}".rstrip() + "\n"
