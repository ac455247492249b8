"""Identity of sweeps: settings as plain data, their fingerprint, their differences."""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import inspect
import json
import pickle
from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np

from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["described", "differences", "digest", "fingerprint"]

# Longer sequences are told apart by a digest.
MOST_LISTED = 64


def described(value: object) -> Any:
    """Return a value as data that JSON can hold, equal for equal values.

    Parameters
    ----------
    value : object
        Numbers, texts, arrays, parameter objects, functions, and what holds them.

    Returns
    -------
    object
        Dictionaries, lists, texts, numbers.
    """
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, np.generic):
        return described(value.item())
    if isinstance(value, np.ndarray):
        return _listed([described(each) for each in value.tolist()])
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        public = (field for field in dataclasses.fields(value) if not field.name.startswith("_"))
        return {**_class(value), **{f.name: described(getattr(value, f.name)) for f in public}}
    if isinstance(value, Mapping):
        return {str(key): described(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return _listed([described(each) for each in value])
    if callable(value):
        return _function(value)
    try:
        state = pickle.dumps(value, protocol=4)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        rule = "hold what can be pickled, by which its folder is recognized"
        raise InvalidParameterError("study", rule, Shown(f"{type(value).__qualname__}: {error}")) from error
    return {**_class(value), "sha256": _bytes_digest(state)}


def _class(value: object) -> dict[str, Any]:
    """Return the name of the class of an object, and of one that is not of this package its source."""
    own = type(value).__module__.partition(".")[0] == __name__.partition(".")[0]
    return {"type": type(value).__qualname__, **({} if own else {"source": _source(type(value))})}


def _listed(values: list[Any]) -> Any:
    if len(values) <= MOST_LISTED:
        return values
    return {"length": len(values), "sha256": digest(values)}


def _function(function: Callable[..., Any]) -> dict[str, Any]:
    """Return name and source of a function, and what it is bound to."""
    if isinstance(function, functools.partial):
        bound = {"arguments": described(function.args), "keywords": described(function.keywords)}
        return {**_function(function.func), **bound}
    named: Any = function if hasattr(function, "__qualname__") else type(function)
    found = {"function": f"{named.__module__}.{named.__qualname__}", "source": _source(named)}
    owner = getattr(function, "__self__", function if named is not function else None)
    if owner is not None:
        found["state"] = described(vars(owner)) if hasattr(owner, "__dict__") else described(repr(owner))
    return found


def _source(named: Any) -> str | None:
    """Return the digest of the source text, if there is one."""
    try:
        return digest(inspect.getsource(named))
    except (OSError, TypeError):
        return None


def digest(value: object) -> str:
    """Return a short digest of data that JSON can hold."""
    return _bytes_digest(json.dumps(value, sort_keys=True).encode("utf-8"))


def _bytes_digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:32]


def fingerprint(settings: Mapping[str, Any]) -> str:
    """Return the digest of all settings of a sweep."""
    return digest(settings)


def differences(first: Any, second: Any, path: str = "") -> Iterator[tuple[str, Any, Any]]:
    """Yield the paths at which two settings differ, with both values.

    Parameters
    ----------
    first, second : object
        Data as read from JSON.
    path : str
        Where they stand.

    Yields
    ------
    tuple
        Path, value in the first, value in the second; ``None`` where there is none.
    """
    if isinstance(first, dict) and isinstance(second, dict):
        for key in dict.fromkeys([*first, *second]):
            yield from differences(first.get(key), second.get(key), f"{path}.{key}" if path else key)
    elif isinstance(first, list) and isinstance(second, list) and len(first) == len(second):
        for index, (one, other) in enumerate(zip(first, second, strict=True)):
            yield from differences(one, other, f"{path}[{index}]")
    elif json.dumps(first) != json.dumps(second):
        yield path, first, second
