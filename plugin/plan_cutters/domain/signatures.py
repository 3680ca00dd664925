"""Signatures for people: `help` and editors see neither names nor defaults of what a function hands on as `**words`."""

import inspect
from collections.abc import Callable
from typing import Any, TypeVar, get_type_hints

_Function = TypeVar("_Function", bound=Callable[..., Any])


def spelled_out(words: type, made: type) -> Callable[[_Function], _Function]:
    """Show a function with each of its `**words` in their place.

    `words` is their type, a TypedDict; `made` is the class that takes them and has their order and defaults: what it does not
    take itself is None where it is not given.
    """

    def shown(function: _Function) -> _Function:
        plain, types = inspect.signature(function), get_type_hints(words)
        own = {name: each for name, each in plain.parameters.items() if each.kind is not each.VAR_KEYWORD}
        known = inspect.signature(made).parameters
        for name in [*(each for each in known if each in types), *(each for each in types if each not in known)]:
            default = known[name].default if name in known else None
            word = inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=types[name])
            own.setdefault(name, word)
        vars(function)["__signature__"] = plain.replace(parameters=list(own.values()))
        return function

    return shown
