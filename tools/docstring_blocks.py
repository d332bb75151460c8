"""A griffe extension for make docs: doctests become blocks of code, comments after fields describe the fields."""

import re
from typing import Any

import griffe

DOCTEST = re.compile(r"^>>> .*(?:\n(?!\s*$).*)*", re.MULTILINE)
COMMENT = re.compile(r"""^[^"'#]*(?:"[^"]*"[^"'#]*|'[^']*'[^"'#]*)*#\s*(?!fmt:|type:|noqa)(.+)$""")


class DocstringBlocks(griffe.Extension):
    """Fences doctests, which Markdown would take for quotations and links, and documents fields by their comments."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        if obj.docstring is not None:
            obj.docstring.value = DOCTEST.sub(lambda found: f"```pycon\n{found[0]}\n```", obj.docstring.value)

    def on_attribute(self, *, attr: griffe.Attribute, **_: Any) -> None:
        if attr.docstring is None and attr.lineno is not None and attr.lineno == attr.endlineno:
            # griffe gives a list of folders for a namespace package, whose attributes have no lines
            path = attr.filepath
            comment = None if isinstance(path, list) else COMMENT.match(attr.lines_collection[path][attr.lineno - 1])
            if comment:
                attr.docstring = griffe.Docstring(comment[1].strip(), lineno=attr.lineno, parent=attr)
