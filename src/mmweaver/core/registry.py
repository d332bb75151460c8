"""Registries of entries selected by name: built in, registered by a program, or provided by an installed plug-in."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from mmweaver.core.errors import InputError

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

Entry = TypeVar("Entry")


class Registry(Mapping[str, Entry]):
    """Mapping from name to entry that raises InputError for unknown names."""

    def __init__(self, kind: str, entries: list[tuple[str, Entry]], *, entry_points: str | None = None):
        """Creates a registry.

        Args:
            kind: What the entries are, for error messages.
            entries: Built-in (name, entry) pairs.
            entry_points: Entry-point group through which installed packages provide further entries; these are looked
                up only for names that are not built in, and loaded at first use. Default: no plug-ins.

        Raises:
            RuntimeError: If two built-in entries share a name.
        """
        self.kind = kind
        self._group = entry_points
        self._entries: dict[str, Entry] = {}
        for name, entry in entries:
            if name in self._entries:
                raise RuntimeError(f"two entries named {name!r} among the {kind}s")
            self._entries[name] = entry

    def register(self, name: str, entry: Entry) -> None:
        """Adds an entry; registering the same entry again has no effect.

        Args:
            name: Name of the entry.
            entry: The entry.

        Raises:
            InputError: If the name is taken by another entry.
        """
        if self._entries.get(name, entry) is not entry:
            raise InputError(f"there is a {self.kind} {name!r} already; choose another name")
        self._entries[name] = entry

    def __getitem__(self, name: str) -> Entry:
        if name not in self._entries:
            if name not in self._plugins:
                raise InputError(f"unknown {self.kind} {name!r}; known: {', '.join(self)}")
            self._entries[name] = load_plugin(self._plugins[name])
        return self._entries[name]

    def __contains__(self, name: object) -> bool:
        return name in self._entries or name in self._plugins

    def __iter__(self) -> Iterator[str]:
        return iter(dict.fromkeys((*self._entries, *self._plugins)))

    def __len__(self) -> int:
        return len(list(iter(self)))

    @cached_property
    def _plugins(self) -> "dict[str, EntryPoint]":
        return {} if self._group is None else plugins(self._group)


def plugins(group: str) -> "dict[str, EntryPoint]":
    """Lists the entry points of a group.

    Args:
        group: Name of the group.

    Returns:
        Entry points by name; the first one found wins.
    """
    from importlib.metadata import entry_points

    found: dict[str, EntryPoint] = {}
    for one in entry_points(group=group):
        found.setdefault(one.name, one)
    return found


def load_plugin(plugin: "EntryPoint") -> Any:
    """Imports the object of an entry point.

    Args:
        plugin: The entry point.

    Returns:
        The object.

    Raises:
        InputError: If it cannot be imported.
    """
    try:
        return plugin.load()
    except Exception as error:  # a plug-in can fail in any way
        package = f" of {plugin.dist.name} {plugin.dist.version}" if plugin.dist else ""
        raise InputError(
            f"plug-in {plugin.name!r}{package} ({plugin.group}: {plugin.value}) cannot be loaded:"
            f" {type(error).__name__}: {error}; update or uninstall it"
        ) from error
