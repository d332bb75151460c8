"""Names that arrive from outside as strings."""

from collections.abc import Iterator, Mapping
from typing import TypeVar

from mmweaver.core.errors import InputError

Entry = TypeVar("Entry")


class Registry(Mapping[str, Entry]):
    """A read-only table from name to entry; a second entry of one name is a bug, an unknown name an InputError."""

    def __init__(self, kind: str, entries: list[tuple[str, Entry]]):
        self.kind = kind
        self._entries: dict[str, Entry] = {}
        for name, entry in entries:
            if name in self._entries:
                raise RuntimeError(f"two entries named {name!r} among the {kind}s")
            self._entries[name] = entry

    def __getitem__(self, name: str) -> Entry:
        try:
            return self._entries[name]
        except KeyError:
            raise InputError(f"unknown {self.kind} {name!r}; known: {', '.join(self._entries)}") from None

    def __contains__(self, name: object) -> bool:
        return name in self._entries

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)
