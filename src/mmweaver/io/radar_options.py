"""Options after the name of a radar: `profile.cfg#subframe=1;antennas=aop;lanes=4`."""

from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from mmweaver.core.antenna_pattern import read_pattern
from mmweaver.core.boards import ANTENNAS, halfwave_positions
from mmweaver.core.errors import InputError
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.safe_files.safe_text import read_json
from mmweaver.core.virtual_array import AntennaTable, antenna_table

EXAMPLE = '{"tx": [[0, 0], [4, 0]], "rx": [[0, 0], [1, 0], [2, 0], [3, 0]]}'


@dataclass(frozen=True, kw_only=True)
class RadarOptions:
    """Choices that a radar file leaves open or that override it; None keeps the file's.

    Attributes:
        sub_frame: Index of a sub-frame of an advanced frame.
        antennas: Antenna table of the board.
        lanes: LVDS lanes of a DCA1000 recording.
        pattern: File with the pattern of one antenna, `antenna_tables.read_pattern`.
    """

    sub_frame: int | None = None
    antennas: AntennaTable | None = None
    lanes: int | None = None
    pattern: str | None = None

    def applied(self, config: RadarConfig) -> RadarConfig:
        """Applies antennas and lanes to a preset or a radar.json.

        Args:
            config: The radar.

        Returns:
            The modified radar.

        Raises:
            InputError: If a sub-frame is given, or the antenna table does not match.
        """
        if self.sub_frame is not None:
            raise InputError(f"radar {config.name!r} has no sub-frames; leave out --radar-set subframe=N")
        if self.lanes is not None:
            config = replace(config, lvds_lanes=self.lanes)
        return self.with_pattern(self._with_antennas(config))

    def with_pattern(self, config: RadarConfig) -> RadarConfig:
        """The radar with the antenna pattern of a file, if one is given."""
        return config if self.pattern is None else replace(config, antenna_pattern=read_pattern(self.pattern))

    def _with_antennas(self, config: RadarConfig) -> RadarConfig:
        table = self.antennas
        if table is None:
            return config
        if (config.num_tx, config.num_rx) != (len(table.tx_halfwaves), len(table.rx_halfwaves)):
            raise InputError(
                f"antenna table {table.name!r} has {len(table.tx_halfwaves)} transmitters and {len(table.rx_halfwaves)}"
                f" receivers, radar {config.name!r} has {config.num_tx} and {config.num_rx}"
            )
        return replace(
            config,
            rx_inverted=table.rx_inverted,
            **dict(table.electrical),
            tx_position_m=halfwave_positions(table.tx_halfwaves, config.centre_frequency_hz),
            rx_position_m=halfwave_positions(table.rx_halfwaves, config.centre_frequency_hz),
        )


def split_radar(name: str) -> tuple[str, RadarOptions]:
    """Splits a radar's name from its options.

    Args:
        name: Name or path, optionally followed by "#" and options.

    Returns:
        Name or path, and the options.

    Raises:
        InputError: If an option is unknown or malformed.
    """
    path, mark, rest = name.rpartition("#")
    if not mark or "=" not in rest:
        return name, RadarOptions()
    values: dict[str, str] = {}
    for part in rest.split(";"):
        key, _, value = part.partition("=")
        values[key] = value
    if unknown := sorted(set(values) - {"subframe", "antennas", "lanes", "pattern"}):
        raise InputError(f"{name!r}: unknown option {unknown[0]!r}; known are subframe, antennas, lanes and pattern")
    try:
        sub_frame, lanes = (int(values[key]) if key in values else None for key in ("subframe", "lanes"))
    except ValueError:
        raise InputError(f"{name!r}: subframe and lanes are whole numbers") from None
    table = None if "antennas" not in values else read_antennas(values["antennas"])
    return path, RadarOptions(sub_frame=sub_frame, antennas=table, lanes=lanes, pattern=values.get("pattern"))


def joined_radar(
    name: str, *, sub_frame: int | None = None, antennas: str | None = None, lanes: int | None = None
) -> str:
    """Appends options to a radar's name; inverse of `split_radar`.

    Args:
        name: Name or path.
        sub_frame: Index of a sub-frame.
        antennas: Name of a board or path of a table.
        lanes: LVDS lanes.

    Returns:
        Name with options.

    >>> joined_radar("profile.cfg", sub_frame=1, lanes=4)
    'profile.cfg#subframe=1;lanes=4'
    """
    given = {"subframe": sub_frame, "antennas": antennas, "lanes": lanes}
    words = ";".join(f"{key}={value}" for key, value in given.items() if value is not None)
    return f"{name}#{words}" if words else name


def read_antennas(name_or_path: str) -> AntennaTable:
    """Loads an antenna table.

    Args:
        name_or_path: Name of a known board, or path of a .json with positions (x, z) in half wavelengths.

    Returns:
        The table.

    Raises:
        InputError: If the name is unknown or the file is malformed.
    """
    path = Path(name_or_path)
    if name_or_path in ANTENNAS or path.suffix.lower() != ".json":
        return ANTENNAS[name_or_path]
    values: Any = read_json(path)
    try:
        return antenna_table(path.stem, values, str(path))
    except (ValueError, KeyError, TypeError, AttributeError):
        raise InputError(f"{path} is no table of antennas; write for example {EXAMPLE}, in half wavelengths") from None
