"""What can be broken in a source file: one small change each, of kinds that change what a document promises.

Annotations, docstrings, decorators, subscripts, logging and `__repr__` are left as they are.
"""

import ast
import re
from bisect import bisect_right
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

OPERATORS: dict[type[ast.operator], tuple[str, str, str]] = {
    ast.Add: ("sign", "+", "-"), ast.Sub: ("sign", "-", "+"),
    ast.Mult: ("factor", "*", "/"), ast.Div: ("factor", "/", "*"),
}  # fmt: skip
COMPARISONS: dict[type[ast.cmpop], tuple[str, str]] = {
    ast.Lt: ("<", ">="), ast.LtE: ("<=", ">"), ast.Gt: (">", "<="), ast.GtE: (">=", "<"),
    ast.Eq: ("==", "!="), ast.NotEq: ("!=", "=="),
}  # fmt: skip
_PAIRS = (
    "min max", "minimum maximum", "fmin fmax", "amin amax", "nanmin nanmax", "argmin argmax", "any all",
    "floor ceil", "sin cos", "radians degrees", "deg2rad rad2deg", "cumsum cumprod",
)  # fmt: skip
TURNED: dict[str, str] = {a: b for pair in _PAIRS for a, b in (pair.split(), pair.split()[::-1])}
GUARDS = re.compile(r"fsync|flush|check|verify|validate|require|ensure|warn|print|unlink|rmtree|rename|replace|refuse")
UNITS = re.compile(r"_(m|mm|s|us|hz|rad|deg|mps|db|dbm|bytes|mb|px|rows?|columns?|frames?|index|axis)$")
SYMMETRIC = {"isinstance", "hypot", "isclose", "allclose", "array_equal", "zip", "gcd", "dot", *TURNED}
QUIET = re.compile(r"^(log|logger|logging|_log|LOG|tqdm|progress)\b")
UNSEEN = {"__repr__", "__str__", "_repr_html_", "_repr_mimebundle_"}
PATHS = re.compile(r"(path|folder|directory|root|dir|cache)\w*(\(.*\)|\.parent)*$", re.IGNORECASE)
TINY = 1e-6  # what keeps a division from zero; ten times as much is seen by nobody


@dataclass(frozen=True)
class Mutation:
    """`before` at byte `start` of the file becomes `after`; `lines` are those of its statement."""

    line: int
    lines: range
    kind: str
    start: int
    before: str
    after: str
    bound: tuple[str, ...] = ()  # at import, nobody calls the line: the names that it binds

    def apply(self, source: bytes) -> bytes:
        end = self.start + len(self.before.encode())
        return source[: self.start] + self.after.encode() + source[end:]


def mutations(source: bytes) -> list[Mutation]:
    """All mutations of a file."""
    finder = _Finder(source)
    finder.visit(ast.parse(source))
    return finder.found


def changes_the_program(source: bytes, mutation: Mutation) -> bool:
    """Whether the mutated file compiles, and to something else."""
    try:
        return ast.dump(ast.parse(mutation.apply(source))) != ast.dump(ast.parse(source))
    except SyntaxError:
        return False


class _Finder(ast.NodeVisitor):
    def __init__(self, source: bytes) -> None:
        self.source = source
        self.line_starts = [0]
        for line in source.splitlines(keepends=True):
            self.line_starts.append(self.line_starts[-1] + len(line))
        self.found: list[Mutation] = []
        self.lines = range(0)
        self.bound: tuple[str, ...] = ()
        self.is_called = False  # within a function

    # positions

    def _start(self, node: ast.expr | ast.stmt) -> int:
        return self.line_starts[node.lineno - 1] + node.col_offset

    def _end(self, node: ast.expr | ast.stmt) -> int:
        assert node.end_lineno is not None
        assert node.end_col_offset is not None
        return self.line_starts[node.end_lineno - 1] + node.end_col_offset

    def _text(self, node: ast.expr | ast.stmt) -> str:
        return self.source[self._start(node) : self._end(node)].decode()

    def _add(self, kind: str, node: ast.expr | ast.stmt, after: str) -> None:
        self._add_at(kind, self._start(node), self._text(node), after)

    def _add_at(self, kind: str, start: int, before: str, after: str) -> None:
        line = bisect_right(self.line_starts, start)
        self.found.append(Mutation(line, self.lines, kind, start, before, after, self.bound))

    def _add_between(self, kind: str, left: ast.expr, right: ast.expr, before: str, after: str) -> None:
        """At the operator between two operands; a comment between them is passed over."""
        gap = re.sub(
            rb"#[^\n]*", lambda comment: b" " * len(comment[0]), self.source[self._end(left) : self._start(right)]
        )
        at = gap.find(before.encode())
        if at >= 0:
            self._add_at(kind, self._end(left) + at, before, after)

    # statements

    def visit(self, node: ast.AST) -> None:
        if not isinstance(node, ast.stmt):
            super().visit(node)
            return
        kept = self.lines, self.bound
        body = getattr(node, "body", None)
        last = body[0].lineno - 1 if body else node.end_lineno
        self.lines = range(node.lineno, max(node.lineno, last or 0) + 1)
        if not self.is_called:
            self.bound = tuple(_bound(node))
        super().visit(node)
        self.lines, self.bound = kept

    def visit_FunctionDef(self, node: ast.FunctionDef) -> None:
        self._function(node)

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef) -> None:
        self._function(node)

    def _function(self, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        if node.name in UNSEEN:
            return
        kept = self.lines, self.is_called
        self.lines = range(node.body[0].lineno, (node.end_lineno or 0) + 1)  # whoever calls it reads its defaults
        for default in [*node.args.defaults, *node.args.kw_defaults]:
            if default is not None:
                self.visit(default)
        self.is_called, self.bound = True, ()
        for statement in node.body:
            self.visit(statement)
        self.lines, self.is_called = kept

    def visit_ClassDef(self, node: ast.ClassDef) -> None:
        for statement in node.body:
            self.visit(statement)

    def visit_AnnAssign(self, node: ast.AnnAssign) -> None:
        if node.value is not None:
            self.visit(node.value)

    def visit_If(self, node: ast.If) -> None:
        if "TYPE_CHECKING" in self._text(node.test) or "__name__" in self._text(node.test):
            return
        self._negate(node.test)
        if isinstance(node.body[0], ast.Raise) and "sorted(" in self._text(node.test):
            self.visit(node.body[0])  # which of several is refused first is promised nowhere
            return
        self.generic_visit(node)

    def visit_IfExp(self, node: ast.IfExp) -> None:
        self._negate(node.test)
        self.generic_visit(node)

    def _negate(self, test: ast.expr) -> None:
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            self._add("condition", test, f"({self._text(test.operand)})")
        elif not isinstance(test, ast.Compare | ast.BoolOp):
            self._add("condition", test, f"(not ({self._text(test)}))")

    def visit_Raise(self, node: ast.Raise) -> None:
        if node.exc is not None:
            self._add("guard", node, "pass")
            for part in ast.walk(node.exc):
                if isinstance(part, ast.JoinedStr):
                    self._message(part)

    def visit_Expr(self, node: ast.Expr) -> None:
        call = node.value
        if not isinstance(call, ast.Call) or QUIET.match(self._text(call)):
            return
        name = self._text(call.func).rpartition(".")[2]
        if GUARDS.search(name):
            self._add("guard", node, "pass")
        if name == "sort":
            self._add("order", node, "pass")
        if name in ("print", "warn"):
            for part in ast.walk(call):
                if isinstance(part, ast.JoinedStr):
                    self._message(part)
        self.generic_visit(node)

    def visit_AugAssign(self, node: ast.AugAssign) -> None:
        if type(node.op) in OPERATORS and not _is_sequence(node.value):
            kind, before, after = OPERATORS[type(node.op)]
            self._add_between(kind, node.target, node.value, before, after)
        self.visit(node.value)

    def visit_Assert(self, node: ast.Assert) -> None:
        """For type checkers."""

    # expressions

    def visit_JoinedStr(self, node: ast.JoinedStr) -> None:
        """Python 3.11 gives no places within f-strings."""

    def _message(self, node: ast.JoinedStr) -> None:
        """Two values of a message change places; a single one is left out."""
        text = self._text(node)
        values = list(re.finditer(r"(?<!\{)\{([^{}]+)\}(?!\})", text))
        if len(values) > 1 and values[0][1] != values[1][1]:
            one, other = values[:2]
            swapped = text[: one.start()] + other[0] + text[one.end() : other.start()] + one[0] + text[other.end() :]
            self._add("message", node, swapped)
        elif values:
            self._add("message", node, text[: values[0].start()] + text[values[0].end() :])

    def visit_BinOp(self, node: ast.BinOp) -> None:
        if isinstance(node.op, ast.MatMult):
            if self._text(node.left).partition("[")[0] == self._text(node.right).partition("[")[0]:
                return  # parts of one signal: a sum that does not depend on their order
            self._add("order", node, f"({self._text(node.right)}) @ ({self._text(node.left)})")
        elif type(node.op) in OPERATORS and not (_is_sequence(node.left) or _is_sequence(node.right)):
            kind, before, after = OPERATORS[type(node.op)]
            if not (before == "/" and PATHS.search(self._text(node.left))):
                self._add_between(kind, node.left, node.right, before, after)
        self.generic_visit(node)

    def visit_UnaryOp(self, node: ast.UnaryOp) -> None:
        if isinstance(node.op, ast.USub) and self._text(node) != "-1":
            self._add("sign", node, f"({self._text(node.operand)})")
        self.generic_visit(node)

    def visit_Compare(self, node: ast.Compare) -> None:
        for left, operator, right in zip([node.left, *node.comparators], node.ops, node.comparators, strict=False):
            if type(operator) in COMPARISONS:
                self._add_between("comparison", left, right, *COMPARISONS[type(operator)])
        self.generic_visit(node)

    def visit_BoolOp(self, node: ast.BoolOp) -> None:
        before, after = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        self._add_between("condition", node.values[-2], node.values[-1], before, after)
        self.generic_visit(node)

    def visit_Subscript(self, node: ast.Subscript) -> None:
        text = self._text(node)
        if text.endswith("[::-1]"):
            self._add("order", node, self._text(node.value))
        self.visit(node.value)

    def visit_Constant(self, node: ast.Constant) -> None:
        value = node.value
        if isinstance(value, bool | complex) or not isinstance(value, int | float):
            return
        text = self._text(node)
        if isinstance(value, int):
            if value > 2:
                self._add("constant", node, f"({text} * 10)")
        elif value not in (0.0, 1.0) and abs(value) > TINY:
            for after in (f"({text} * 10)", f"({text} * 1000)", f"(-{text})"):
                self._add("constant", node, after)

    def visit_Call(self, node: ast.Call) -> None:
        name = self._text(node.func).rpartition(".")[2]
        if QUIET.match(self._text(node)):
            return
        if name in TURNED:
            kind = "extremum" if re.search("min|max", name) else "function"
            self._add_at(kind, self._end(node.func) - len(name), name, TURNED[name])
        elif name == "sorted":
            self._add("order", node, f"{self._text(node)}[::-1]")
        elif name == "reversed":
            self._add("order", node, f"list({self._text(node.args[0])})")
        elif name == "conj":
            inner = node.args[0] if node.args else node.func.value if isinstance(node.func, ast.Attribute) else node
            self._add("sign", node, f"({self._text(inner)})")
        elif name == "stream" and len(node.args) > 1:
            self._seed(node)
        self._swap(node, name)
        for part in [*node.args, *(word.value for word in node.keywords if word.arg not in ("axis", "dim", "indent"))]:
            self.visit(part)
        if isinstance(node.func, ast.Attribute):
            self.visit(node.func.value)

    def _seed(self, node: ast.Call) -> None:
        seed, *purposes = node.args
        if not isinstance(seed, ast.Constant):
            self._add("seed", seed, "0")
        for purpose in purposes:
            if not isinstance(purpose, ast.Constant | ast.Starred):
                self._add("seed", purpose, "0")

    def _swap(self, node: ast.Call, name: str) -> None:
        """Two arguments of one unit, or two symbols, change places."""
        if len(node.args) < 2 or name in SYMMETRIC:
            return
        one, other = (self._text(argument) for argument in node.args[:2])
        units = [UNITS.search(text) for text in (one, other)]
        same_unit = units[0] and units[1] and units[0][0] == units[1][0]
        if one != other and (
            same_unit or (one.isidentifier() and other.isidentifier() and max(len(one), len(other)) < 3)
        ):
            between = self.source[self._end(node.args[0]) : self._start(node.args[1])].decode()
            self._add_at("arguments", self._start(node.args[0]), one + between + other, other + between + one)


def _bound(node: ast.stmt) -> Iterator[str]:
    targets: Sequence[ast.expr] = getattr(node, "targets", None) or [getattr(node, "target", ast.Constant(0))]
    for target in targets:
        yield from (part.id for part in ast.walk(target) if isinstance(part, ast.Name))


def _is_sequence(node: ast.expr) -> bool:
    """Strings, lists and tuples, which are joined or repeated, not added."""
    if isinstance(node, ast.BinOp):
        return _is_sequence(node.left) or _is_sequence(node.right)
    is_text = isinstance(node, ast.Constant) and isinstance(node.value, str | bytes)
    return is_text or isinstance(node, ast.JoinedStr | ast.List | ast.Tuple | ast.ListComp)
