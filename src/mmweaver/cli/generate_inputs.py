"""Inputs of `mmweaver generate`: the radar, the generator, the room."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from mmweaver.core.errors import InputError
from mmweaver.core.options import read_settings

if TYPE_CHECKING:
    from mmweaver.cli.generate import Options
    from mmweaver.core.radar_config import RadarConfig
    from mmweaver.core.records import RadarCube
    from mmweaver.weaver.front_door import Weaver
    from mmweaver.weaver.generation import Room

DEFAULT_RADAR = "awr1843"


def read_background(asked: "Options") -> "RadarCube | None":
    """The background recording, if one is given.

    Raises:
        InputError: If it is not a recording.
    """
    if asked.background is None:
        return None
    from mmweaver.recordings.read_recording import read_recording

    return read_recording(asked.background, range_m=asked.range_m, range_bins=asked.range_bins).cube


def radar_of(asked: "Options", background: "RadarCube | None") -> "RadarConfig":
    """The radar, from the options or the background recording.

    Args:
        asked: The options.
        background: The background recording, if any.
    """
    from dataclasses import replace

    from mmweaver.core.range_window import chosen_range
    from mmweaver.io.radar_file import load_radar

    is_own = background is not None and asked.radar is None
    config = (
        background.config if background is not None and is_own else load_radar(asked.radar_name(DEFAULT_RADAR) or "")
    )
    config = chosen_range(config, asked.range_m, asked.range_bins)
    return config if asked.tx_order is None else replace(config, tx_order=asked.tx_order)


def weaver_of(asked: "Options", radar: "RadarConfig", listener: "Callable[[str], object] | None" = None) -> "Weaver":
    """The generator for the options.

    Args:
        asked: The options.
        radar: The radar.
        listener: Called with the name of each stage as it begins.
    """
    from mmweaver.io.radar_file import load_firmware
    from mmweaver.io.ti_calibration import read_ti_calibration
    from mmweaver.models.methods import Learned, Physics
    from mmweaver.propagation.static_paths import ALL_PATHS, Propagation
    from mmweaver.weaver.front_door import Weaver

    name = asked.radar_name(DEFAULT_RADAR) or ""
    weaver = Weaver(
        method=asked.method,
        radar=radar,
        listener=listener,
        points=asked.points,
        weights=asked.weights,
        firmware=load_firmware(asked.radar or DEFAULT_RADAR) if asked.points == "firmware" else None,
        calibration=read_ti_calibration(name),
    )
    settings = {"bounces": 2, "clutter": "all"} | read_settings(
        asked.method_set, {"bounces": int, "clutter": str}, "method-set"
    )
    if settings["bounces"] not in (1, 2) or settings["clutter"] not in ("all", "resolved"):
        raise InputError("--method-set has bounces=1 or 2 and clutter=all or resolved")
    propagation = Propagation(bounces=settings["bounces"], clutter=settings["clutter"] == "all")
    if propagation != ALL_PATHS:
        if not isinstance(weaver.method, Physics | Learned):
            raise InputError(f"--method-set is for weaver and physics, not for {asked.method}; leave it out")
        weaver.method.propagation = propagation
    return weaver


def room_of(asked: "Options", weaver: "Weaver", background: "RadarCube | None") -> "Room":
    """The room with its landmarks and its background recording.

    Args:
        asked: The options.
        weaver: Reader of rooms.
        background: The background recording, if any.
    """
    room = asked.read_room(weaver)
    room = room.with_furniture(*asked.furnish, seed=asked.seed) if asked.furnish else room
    room = room.with_landmarks(*asked.landmark) if asked.landmark else room
    return room if background is None else room.with_background(background, came_from=asked.background)
