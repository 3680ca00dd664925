"""Small faults that can be put into a source: each changes one place of its syntax tree, as a slip of the pen would."""

import ast
import copy
import difflib
import random
import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

COMPARED = {
    ast.Lt: (ast.LtE, ast.Gt),
    ast.LtE: (ast.Lt,),
    ast.Gt: (ast.GtE, ast.Lt),
    ast.GtE: (ast.Gt,),
    ast.Eq: (ast.NotEq,),
    ast.NotEq: (ast.Eq,),
    ast.Is: (ast.IsNot,),
    ast.IsNot: (ast.Is,),
    ast.In: (ast.NotIn,),
    ast.NotIn: (ast.In,),
}
COMPUTED = {
    ast.Add: ast.Sub,
    ast.Sub: ast.Add,
    ast.Mult: ast.Div,
    ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult,
    ast.Mod: ast.Mult,
    ast.Pow: ast.Mult,
    ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd,
    ast.LShift: ast.RShift,
    ast.RShift: ast.LShift,
}
ARITHMETIC = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)
SWAPPED = {"min": "max", "minimum": "maximum", "argmin": "argmax", "any": "all", "floor": "ceil", "nanmin": "nanmax"}
SWAPPED |= {there: here for here, there in SWAPPED.items()}
#: A call that is left out: its first argument stays. `nextafter` rounds to the safe side.
BARE = {"abs", "fabs", "absolute", "nextafter", "nan_to_num"}
NUMBERS = {"sqrt", "hypot", "cos", "sin", "tan", "acos", "asin", "atan2", "dot", *SWAPPED, *BARE}
#: A number up to this is a tolerance, which may be forgotten.
TOLERANCE = 0.01
#: Sizes of chunks and caches change no answer; texts that only people or logs read are none.
SIZES = re.compile(r"chunk|cache|batch|at_a_time|at_once|workers|threads|maxsize|block_size", re.IGNORECASE)
TEXTS = {"__repr__", "__str__"}
SAID = {"warn", "debug", "info", "print", "echo"}
TYPES = {
    "tuple",
    "list",
    "dict",
    "set",
    "frozenset",
    "type",
    "Callable",
    "Literal",
    "NDArray",
    "Annotated",
    "Mapping",
    "Sequence",
}
INDEX = re.compile(r"[ijkmn]|\w*_?index|row|column|first|second|last")


class Mutant(NamedTuple):
    """A fault: bytes of a source from `start` to `end` become `after`."""

    path: str
    function: str
    line: int
    kind: str
    start: int
    end: int
    before: str
    after: str
    #: First and last line of the statement that it stands in; 0 where that runs when its module is imported.
    lines: tuple[int, int]
    #: Which one it is of those in the function that would have the same name.
    number: int

    @property
    def name(self) -> str:
        """Its name, which stays where lines are put above its function."""
        number = f" ({self.number})" if self.number > 1 else ""
        return f"{self.path} {self.function}: {' '.join(self.before.split())} -> {' '.join(self.after.split())}{number}"

    def diff(self, source: bytes) -> list[str]:
        """The lines that it changes, as they were and as they become."""
        here, there = (each.decode().splitlines() for each in (source, self.applied(source)))
        return [row for row in difflib.unified_diff(here, there, lineterm="", n=0) if row[:2] not in ("--", "++", "@@")]

    def applied(self, source: bytes) -> bytes:
        """Put the fault into its source."""
        return source[: self.start] + self.after.encode() + source[self.end :]


def _called(node: ast.AST) -> str:
    """The last name of what a call calls."""
    function = node.func if isinstance(node, ast.Call) else None
    return getattr(function, "id", None) or getattr(function, "attr", "")


def _numbers(node: ast.Constant) -> Iterator[tuple[str, ast.expr]]:
    value = node.value
    if isinstance(value, bool):
        yield "constant", ast.Constant(not value)
    elif isinstance(value, int):
        yield "constant", ast.Constant(value + 1)
        if value > 0:
            yield "constant", ast.Constant(value - 1)
    elif isinstance(value, float):
        others = [0.0, 2.0 * value] if 0.0 < value <= TOLERANCE else [1.01 * value, 2.0 * value]
        yield from (("constant", ast.Constant(each)) for each in (others if value else [1.0]))


def _with(node: ast.expr, **changed: object) -> ast.expr:
    other = copy.copy(node)
    for name, value in changed.items():
        setattr(other, name, value)
    return other


def _renamed(node: ast.Call, name: str) -> ast.expr:
    field = "id" if isinstance(node.func, ast.Name) else "attr"
    return _with(node, func=_with(node.func, **{field: name}))


def _expressions(node: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    """Kinds of faults in an expression, each with what it becomes."""
    match node:
        case ast.Compare(ops=ops):
            for k, each in enumerate(ops):
                for other in COMPARED[type(each)]:
                    yield "comparison", _with(node, ops=[*ops[:k], other(), *ops[k + 1 :]])
        case ast.BinOp(op=op) if type(op) in COMPUTED and not any(_text(each) for each in (node.left, node.right)):
            yield "operator", _with(node, op=COMPUTED[type(op)]())
        case ast.UnaryOp(op=ast.USub() | ast.Not() | ast.Invert(), operand=operand):
            yield "sign" if isinstance(node.op, ast.USub) else "not", operand
        case ast.BoolOp(op=op):
            yield "and/or", _with(node, op=ast.Or() if isinstance(op, ast.And) else ast.And())
        case ast.Constant():
            yield from _numbers(node)
        case ast.Call() if _called(node) in SWAPPED:
            yield "min/max", _renamed(node, SWAPPED[_called(node)])
        case ast.Call(args=[first, *_]) if _called(node) in BARE:
            yield "abs", first
        case ast.Subscript(slice=ast.Name(id=name) | ast.BinOp(left=ast.Name(id=name))) if INDEX.fullmatch(name):
            yield "index", _with(node, slice=ast.BinOp(node.slice, ast.Add(), ast.Constant(1)))


def _text(node: ast.expr) -> bool:
    return isinstance(node, ast.JoinedStr) or (isinstance(node, ast.Constant) and isinstance(node.value, str))


def _conditions(node: ast.AST) -> Iterator[tuple[ast.expr, bool]]:
    """Conditions that a node asks, each with a value that it may be replaced by."""
    if isinstance(node, ast.If | ast.IfExp):
        yield from ((node.test, value) for value in (True, False))
    elif isinstance(node, ast.While) and not isinstance(node.test, ast.Constant):
        yield node.test, False
    elif isinstance(node, ast.comprehension):
        yield from ((each, True) for each in node.ifs)


def _number(node: ast.expr | None) -> bool:
    """Whether what is returned is a number, or an array of numbers, by its look."""
    return (isinstance(node, ast.BinOp) and isinstance(node.op, ARITHMETIC)) or _called(node or ast.Pass()) in NUMBERS


class _Walk:
    """Gathers the places of a module at which faults are possible: each place is a list of faults, of which one is drawn."""

    def __init__(self, path: str, source: bytes) -> None:
        self.path, self.source = path, source
        ends = [0, *(match.end() for match in re.finditer(rb"\n", source))]
        self.at = lambda line, column: ends[line - 1] + column
        self.alike: Counter[tuple[str, str, str]] = Counter()
        self.functions: list[str] = []
        self.lines = (0, 0)
        self.places: list[list[Mutant]] = []
        self.visit(ast.parse(source))

    def add(self, node: ast.expr | ast.stmt, kind: str, after: str) -> list[Mutant]:
        start, end = self.at(node.lineno, node.col_offset), self.at(node.end_lineno, node.end_col_offset)
        before = self.source[start:end].decode()
        function = ".".join(self.functions) or "module"
        self.alike[function, before, after] += 1
        number = self.alike[function, before, after]
        return [Mutant(self.path, function, node.lineno, kind, start, end, before, after, self.lines, number)]

    def visit(self, node: ast.AST) -> None:
        if self.left_out(node):
            return
        before, inside = self.lines, isinstance(node, ast.FunctionDef | ast.ClassDef)
        if isinstance(node, ast.stmt):
            body = getattr(node, "body", None)
            last = max(node.lineno, body[0].lineno - 1) if body else node.end_lineno
            self.lines = (node.lineno, last) if self.functions and not inside else (0, 0)
        found = []
        if isinstance(node, ast.expr):
            for kind, other in _expressions(node):
                found += self.add(node, kind, f"({ast.unparse(other)})")
        if isinstance(node, ast.Return) and _number(node.value):
            self.places.append(self.add(node.value, "sign of what is returned", f"-({ast.unparse(node.value)})"))
        gone = isinstance(node, ast.Raise | ast.AugAssign | ast.Continue)
        if gone or (isinstance(node, ast.Expr) and isinstance(node.value, ast.Call)):
            self.places.append(self.add(node, "statement", "pass"))
        if found:
            self.places.append(found)
        for test in dict.fromkeys(each for each, _ in _conditions(node)):
            values = [value for each, value in _conditions(node) if each is test]
            self.places.append([fault for value in values for fault in self.add(test, "condition", str(value))])
        self.functions += [node.name] if inside else []
        for name, child in ast.iter_fields(node):
            if name not in ("annotation", "returns", "decorator_list", "exc", "cause", "msg", "bases", "type_params"):
                for each in child if isinstance(child, list) else [child]:
                    if isinstance(each, ast.AST):
                        self.visit(each)
        if inside:
            self.functions.pop()
        self.lines = before

    def left_out(self, node: ast.AST) -> bool:
        """Whether nothing in a node changes an answer: texts, types, sizes of chunks and caches."""
        match node:
            case ast.JoinedStr() | ast.Assert():
                return True
            case ast.FunctionDef(name=name):
                return name in TEXTS
            case ast.If(test=ast.Name(id="TYPE_CHECKING")):
                return True
            case ast.Assign(targets=[ast.Name(id=name)], value=value) if not self.functions:
                alias = isinstance(value, ast.Subscript) and getattr(value.value, "id", "") in TYPES
                union = (
                    isinstance(value, ast.BinOp)
                    and isinstance(value.op, ast.BitOr)
                    and name[0].isupper()
                    and name != name.upper()
                )
                return name == "__all__" or alias or union or bool(SIZES.search(name))
            case ast.AnnAssign(target=ast.Name(id=name)) | ast.keyword(arg=str(name)):
                return bool(SIZES.search(name))
            case ast.Call() if _called(node) in (*SAID, "isinstance", "TypeVar", "cast"):
                return True
            case ast.Expr(value=ast.Call() as call):
                return _called(call) in SAID
        return False


def places(path: str, source: bytes) -> list[list[Mutant]]:
    """The places of a source at which faults are possible, each with its faults."""
    return _Walk(path, source).places


def drawn(root: Path, paths: list[str], seed: str) -> Iterator[Mutant]:
    """Faults of modules, in an order that a seed says: each place is as likely as any other, and comes once.

    What is compiled to the same code is left out.
    """
    sources = {path: (root / path).read_bytes() for path in sorted(paths)}
    every = [place for path, source in sources.items() for place in places(path, source)]
    chance = random.Random(seed)
    chance.shuffle(every)
    for place in every:
        fault = chance.choice(place)
        source = sources[fault.path]
        try:
            differs = _code(fault.applied(source)) != _code(source)
        except SyntaxError:  # in a pattern, say
            continue
        if differs:
            yield fault


def _code(source: bytes) -> list[object]:
    """What a source is compiled to, without its lines."""
    code, found = [compile(source, "", "exec", dont_inherit=True)], []
    while code:
        each = code.pop()
        inner = [constant for constant in each.co_consts if hasattr(constant, "co_code")]
        found += [each.co_code, each.co_names, repr([c for c in each.co_consts if c not in inner])]
        code += inner
    return found
