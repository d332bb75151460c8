"""What one fit found of a board, or why it could not see it."""

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True, kw_only=True)
class Finding:
    """`fields`: the fields of `Board` that it gives, none where it saw nothing and `text` says why.

    `errors`: one standard error of fields where it is known, in the field's unit, rms over a table's entries.
    """

    title: str
    text: str
    fields: dict[str, Any] = field(default_factory=dict)
    errors: dict[str, float] = field(default_factory=dict)

    @property
    def is_found(self) -> bool:
        return bool(self.fields)
