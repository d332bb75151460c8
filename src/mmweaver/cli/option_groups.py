"""Options that several commands share."""

import json
from typing import Any, Literal

from mmweaver.cli.arguments import General
from mmweaver.core.errors import InputError
from mmweaver.core.options import Setting, Source, option, options

Iq = Literal["float16", "float32", "none"]
IqOrder = Literal["iq", "qi", "interleaved"]


@options
class Printed(General):
    """For commands that print a summary."""

    json: bool = option("print a machine-readable summary on stdout", default=False, is_setting=False)
    quiet: bool = option("print nothing but errors", default=False, is_setting=False)

    def report(self, summary: Any, *lines: str) -> int:
        """Prints a summary, as JSON or as lines of text.

        Args:
            summary: Values for JSON.
            *lines: Lines of text.

        Returns:
            Exit status 0.
        """
        if self.json:
            print(json.dumps(summary, indent=2, ensure_ascii=False))
        elif not self.quiet:
            print(*lines, sep="\n")
        return 0


@options
class Quiet(General):
    """For commands that write files."""

    quiet: bool = option("print nothing but errors", default=False, is_setting=False)
    overwrite: bool = option("replace files that exist", default=False, is_setting=False)


@options
class Written(Printed):
    """For commands that write files and print a summary."""

    overwrite: bool = option("replace files of an earlier run", default=False, is_setting=False)


@options
class Ranges:
    """Range window."""

    range_m: tuple[float, float] | None = option(
        "ranges to keep, in metres (default: a preset's own window; all of a .cfg, up to 4 MiB per frame)",
        "NEAR,FAR",
        name="range",
    )
    range_bins: tuple[int, int] | None = option("the same in range bins", "FIRST,LAST", rare=True)


@options
class RadarSettings(General):
    """Settings that a radar's file does not contain; the command has the radar itself."""

    radar_set: list[Setting] | None = option(
        "what the radar's file leaves open: subframe=N of a .cfg or mmWave Studio file, antennas=NAME|JSON (isk, boost,"
        " boost1642, aop, ods, evm2944, or a JSON with tx and rx in half wavelengths), lanes=2|4 of a DCA1000's .bin,"
        " pattern=FILE.csv of one antenna (azimuth, elevation, dB)",
        "KEY=VALUE",
    )

    def radar_name(self, default: str | None = None) -> str | None:
        """Name of the radar followed by its settings, as `load_radar` reads them.

        Raises:
            InputError: For settings without a radar.
        """
        return radar_name(getattr(self, "radar", None) or default, self.radar_set)


@options
class RadarChoice(RadarSettings):
    """A radar, and settings that its file does not contain."""

    radar: Source | None = option(
        "preset (mmweaver radar lists them), TI .cfg or radar.json; signals are generated for awr1843, or"
        " for the radar of --background, by default",
        "NAME|FILE",
    )


def radar_name(name: str | None, settings: list[Setting] | None) -> str | None:
    """Name of a radar followed by its settings.

    Raises:
        InputError: For settings without a radar.
    """
    if not settings:
        return name
    if name is None:
        raise InputError("--radar-set belongs to a radar; give --radar, too")
    return f"{name}#{';'.join(settings)}"


@options
class Layout:
    """Layout of a DCA1000's .bin."""

    iq_order: IqOrder | None = option(
        "order of I and Q in the .bin: I I Q Q, Q Q I I or I Q I Q (default: as the .cfg or mmWave Studio file says,"
        " else iq)",
        group="raw samples",
    )
    tx_order: tuple[int, ...] | None = option("order in which the transmitters fire (default: the radar's)", "N,N,N")


@options
class Samples(RadarChoice, Layout):
    """Reading of raw samples, which do not state their radar."""

    layout: str | None = option(
        "what a .npy holds: its axes in their order, such as frame,loop,tx,rx,sample, or whose it is: hupr (a frame or"
        " a folder of them), mmmesh, rf_genesis, cubelearn; or a mapping file that says it of a .mat or HDF5 file",
        "AXES|NAME|FILE.toml",
        group="raw samples",
    )

    def reading(self) -> dict[str, Any]:
        """Arguments of the readers of recordings that describe the layout of samples."""
        is_axes = self.layout is not None and "," in self.layout
        return {
            "layout": None if is_axes else self.layout,
            "axes": self.layout if is_axes else None,
            "iq_order": self.iq_order,
            "tx_order": self.tx_order,
        }


@options
class BoardChoice:
    """Board whose errors a signal has."""

    board: Source | None = option(
        "the board whose errors the signal has: typical, sampled by the seed from the spread of recorded boards"
        " (default; typical:N is one of them), ideal, or a board.json of mmweaver calibrate",
        "typical|ideal|FILE",
    )


@options
class PointChoice:
    """Point detector."""

    points: str = option(
        "point cloud: cfar, ours, or firmware, as TI's out-of-box demo would report it with the cfarCfg, peakGrouping,"
        " clutterRemoval and multiObjBeamForming of the radar's .cfg",
        "cfar|firmware",
        default="cfar",
    )
