"""Moving things other than people, and reflectors at rest, as scatterers of one radar.

A thing is a few point scatterers that move by the laws of its row in core/things.toml, as functions of continuous time.
Both methods add their paths, which the room's surfaces hide, as direct echoes by the radar equation.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import RadarPose
from mmweaver.core.records import Scene
from mmweaver.core.rotations import unit
from mmweaver.core.seeding import stream
from mmweaver.core.targets import Reflector, Thing, thing_rows
from mmweaver.propagation.antenna import pattern, scatterer_gain
from mmweaver.propagation.paths import FrameClock, Interaction, Paths, ScenePaths, StaticPaths
from mmweaver.propagation.static_paths import RayTracedRoom, scattered_paths
from mmweaver.propagation.visible_body import motion_through

ROOM_MARGIN_M = 0.25  # a thing is not hidden by the surface that it stands at, or by its own picture in the photo
CORNER_HALF_POWER_DEG = 20.0  # of a triangular trihedral
UP = np.array([0.0, 0.0, 1.0])


@dataclass(frozen=True, kw_only=True)
class ThingTruth:
    """Ground truth of a thing over frames: its middle (frame, 3) in the radar's frame, metres and m/s."""

    kind: str
    place_m: np.ndarray
    velocity_mps: np.ndarray
    facts: dict[str, float]


class MovingThing:
    """The scatterers of one thing: `places` at any time, and their amplitudes."""

    def __init__(self, thing: Thing, floor_z_m: float):
        """Samples what differs between things of a kind.

        Args:
            thing: The thing.
            floor_z_m: Height of the floor in the camera's level frame, metres.
        """
        self.thing, row = thing, thing_rows()[thing.kind]
        rng = stream(thing.seed, "thing", thing.kind)
        x_m, y_m = thing.place_m or (0.0, 0.0)
        self.origin_m = np.array([x_m, y_m, floor_z_m + row["height_m"]])
        towards = np.arctan2(-y_m, -x_m)
        is_travelling = any(part["law"] in ("walk", "drive") for part in row["parts"])
        usual_rad = float(towards + (np.pi / 2 if is_travelling else 0.0))
        self.heading_rad: float = usual_rad if thing.heading_rad is None else thing.heading_rad
        self.luck = rng.random(8)  # shared by the parts: their rates and speeds are one thing's
        level_db = rng.uniform(-row["spread_db"], row["spread_db"])
        self.parts, sections, phases = [], [], []
        for part in row["parts"]:
            local = _local(part, rng)
            self.parts.append((part, local, rng.random((len(local), 4))))
            share = rng.gamma(1.0, 1.0, len(local))
            sections.append(10 ** ((part["dbsm"] + level_db) / 10) * share / share.sum())
            phases.append(np.exp(2j * np.pi * rng.random(len(local))))
        self.cross_section_m2, self.phase = np.concatenate(sections), np.concatenate(phases)

    def places(self, time_s: np.ndarray) -> np.ndarray:
        """Places (time, scatterer, 3) in the camera's level frame at times (time,) in seconds."""
        front = np.array([np.cos(self.heading_rad), np.sin(self.heading_rad), 0.0])
        axes = np.stack([front, np.array([-front[1], front[0], 0.0]), UP])  # front, left, up
        each = [LAWS[part["law"]](part, local, luck, self.luck, time_s) for part, local, luck in self.parts]
        return self.origin_m + np.concatenate(each, axis=1) @ axes

    def middle_m(self, time_s: np.ndarray) -> np.ndarray:
        """Middle (time, 3) of the moving scatterers."""
        moving = np.concatenate([np.full(len(local), part["law"] != "still") for part, local, _ in self.parts])
        return self.places(time_s)[:, moving].mean(axis=1)

    def facts(self) -> dict[str, float]:
        """Rates and speeds that were sampled, for meta.json."""
        part = self.parts[0][0]
        names = [name for name in ("rate_hz", "speed_mps", "amplitude_m") if name in part]
        return {name: round(_sampled(part[name], self.luck[_LUCK[name]]), 5) for name in names}


_LUCK = {"rate_hz": 0, "speed_mps": 1, "amplitude_m": 2}


def _sampled(limits: Sequence[float], luck: float) -> float:
    return float(limits[0] + (limits[1] - limits[0]) * luck)


def _local(part: dict, rng: np.random.Generator) -> np.ndarray:
    """Scatterers (scatterer, 3) of a part about its origin: front, left, up."""
    if part["law"] == "spin":
        radius = np.linspace(*part["radius_m"], part["points"])
        angle = 2 * np.pi * np.arange(part["count"]) / part["count"]
        return np.stack(
            [np.repeat(angle, len(radius)), np.tile(radius, len(angle)), np.zeros(angle.size * radius.size)], 1
        )
    size = np.array(part["size_m"])
    local = (rng.random((part["count"], 3)) - 0.5) * size
    if part["law"] == "hinge":
        local[:, 0] += size[0] / 2
    if part["count"] == 4 and part["law"] == "walk":  # paws at the corners
        local = np.array([[1, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]]) * size / 2
    return local + np.array([part.get("ahead_m", 0.0), 0.0, -part.get("down_m", 0.0)])


def _still(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    return np.broadcast_to(local, (len(time_s), *local.shape))


def _spin(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Blades that turn about an axis, which itself swings to and fro where `turns_deg` is stated."""
    angle = local[:, 0] + 2 * np.pi * (_sampled(part["rate_hz"], own[0]) * time_s[:, None] + own[3])
    side, height = local[:, 1] * np.cos(angle), local[:, 1] * np.sin(angle)
    if part["axis"] == "up":
        return np.stack([side, height, np.zeros_like(side)], axis=-1)
    turns = np.radians(part.get("turns_deg", 0.0)) * np.sin(2 * np.pi * (part.get("turns_hz", 0.0) * time_s + own[4]))
    sine, cosine = np.sin(turns)[:, None], np.cos(turns)[:, None]
    return np.stack([-side * sine, side * cosine, height], axis=-1)


def _sway(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """To and fro in a draught that swells and fades: as a wave along the width, or each scatterer by itself."""
    is_wave = part.get("is_wave", False)
    rate = _sampled(part["rate_hz"], own[0]) if is_wave else np.interp(luck[:, 0], (0, 1), part["rate_hz"])
    phase = 0.6 * local[:, 1] * 2 * np.pi + 0.3 * luck[:, 1] if is_wave else 2 * np.pi * luck[:, 1]
    gust = 0.65 + 0.35 * np.sin(2 * np.pi * (0.11 * time_s[:, None] + own[3]))
    wave = np.sin(2 * np.pi * rate * time_s[:, None] + phase) + 0.3 * np.sin(
        4.6 * np.pi * rate * time_s[:, None] + 2 * phase
    )
    height = (local[:, 2] - local[:, 2].min()) / max(np.ptp(local[:, 2]), 1e-6)
    reach = (1 - height if part["hangs"] else height) + 0.05
    moved = _sampled(part["amplitude_m"], own[2]) * reach * gust * wave
    if part["along"] == "front":
        direction = np.array([1.0, 0.0, 0.0])
    else:
        direction = np.stack([np.cos(2 * np.pi * luck[:, 2]), np.sin(2 * np.pi * luck[:, 2]), 0.3 * luck[:, 3]], -1)
    return local + moved[..., None] * direction


def _hinge(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """A leaf that opens and shuts about the upright axis through its origin."""
    swing = 0.5 - 0.5 * np.cos(2 * np.pi * (_sampled(part["rate_hz"], own[0]) * time_s + own[3]))
    angle = np.pi / 2 + np.radians(part["swings_deg"]) * swing[:, None]
    return np.stack(
        [
            local[:, 0] * np.cos(angle),
            local[:, 0] * np.sin(angle),
            np.broadcast_to(local[:, 2], angle.shape[:1] + local[:, 2].shape),
        ],
        axis=-1,
    )


def _walk(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """To and fro along a line, turning at its ends; paws swing by `step_m`, the trunk rises and falls a little."""
    speed, reach = _sampled(part["speed_mps"], own[1]), part["reach_m"]
    turn = 2 * np.pi * (speed / (4 * reach) * time_s + own[3])
    along = reach * 2 / np.pi * np.arcsin(0.98 * np.sin(turn))
    sign = np.tanh(6 * np.cos(turn))[:, None]  # which way it faces
    stride = 2 * np.pi * part["stride_hz"] * time_s[:, None]
    legs = np.pi * np.array([0, 1, 1, 0])[: len(local)] if "step_m" in part else 2 * np.pi * luck[:, 0]
    step = part.get("step_m", 0.01) / 2 * np.sin(stride + legs)
    lift = part.get("step_m", 0.02) * 0.25 * np.maximum(np.cos(stride + legs), 0.0) ** 2
    x = along[:, None] + sign * (local[:, 0] + step)
    return np.stack([x, sign * local[:, 1], local[:, 2] + lift], axis=-1)


def _drive(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """Along a figure of eight at nearly constant speed, as a robot covers a floor; brushes turn."""
    speed, reach = _sampled(part["speed_mps"], own[1]), part["reach_m"]
    phase = 2 * np.pi * (speed / (5.2 * reach) * time_s + own[3])
    x, y = reach * np.sin(phase), reach / 2 * np.sin(2 * phase)
    facing = np.arctan2(np.cos(2 * phase), np.cos(phase))[:, None]
    facing = facing + 2 * np.pi * part.get("brush_hz", 0.0) * time_s[:, None]
    sine, cosine = np.sin(facing), np.cos(facing)
    return np.stack(
        [
            x[:, None] + cosine * local[:, 0] - sine * local[:, 1],
            y[:, None] + sine * local[:, 0] + cosine * local[:, 1],
            np.broadcast_to(local[:, 2], facing.shape[:1] + local[:, 2].shape),
        ],
        axis=-1,
    )


def _shake(part: dict, local: np.ndarray, luck: np.ndarray, own: np.ndarray, time_s: np.ndarray) -> np.ndarray:
    """A housing that circles by fractions of a millimetre, in bouts."""
    phase = 2 * np.pi * (_sampled(part["rate_hz"], own[0]) * time_s + own[3])
    bout = 0.75 + 0.25 * np.sin(2 * np.pi * (0.09 * time_s + own[4]))
    size = (_sampled(part["amplitude_m"], own[2]) * bout)[:, None] * (1 + 0.2 * (luck[:, 0] - 0.5))
    moved = np.stack([size * np.cos(phase)[:, None], size * np.sin(phase)[:, None], 0 * size], axis=-1)
    return local + moved


LAWS = {
    "still": _still,
    "spin": _spin,
    "sway": _sway,
    "hinge": _hinge,
    "walk": _walk,
    "drive": _drive,
    "shake": _shake,
}


class ThingPaths:
    """Paths over the things of a scene, for one radar."""

    def __init__(self, scene: Scene, config: RadarConfig):
        """Samples the scatterers.

        Args:
            scene: The scene in the radar's frame.
            config: The radar.
        """
        self.config, self.pose = config, scene.radar_pose
        self.things = [MovingThing(one, scene.floor_z_m + scene.radar_pose.z_m) for one in scene.things]

    def added(self, paths: ScenePaths, frames: np.ndarray, clock: FrameClock, room: RayTracedRoom) -> ScenePaths:
        """Adds the paths of all things to those of some frames, see `paths`."""
        own = self.paths(frames, clock, room)
        return paths if own is None else replace(paths, moving=Paths.cat([paths.moving, own], 1))

    def paths(self, frames: np.ndarray, clock: FrameClock, room: RayTracedRoom | None) -> Paths | None:
        """Paths of all things.

        Args:
            frames: Frame numbers (frame,).
            clock: Clock of the radar's frame.
            room: The room whose surfaces hide things; None for free space.

        Returns:
            Paths (frame * segment, path); None without things.
        """
        if not self.things:
            return None
        time_s = (frames[:, None] * self.config.frame_period_s + clock.node_s[None, :]).ravel()
        places = np.concatenate([thing.places(time_s) for thing in self.things], axis=1)
        places = self.pose.seen(places).reshape(len(frames), len(clock.node_s), -1, 3)
        section = np.concatenate([thing.cross_section_m2 for thing in self.things])
        phase = np.concatenate([thing.phase for thing in self.things])
        motion = motion_through(places, clock)  # (frame, segment, scatterer, 3, 3)
        where = motion[..., 0, :]
        distance = np.linalg.norm(where, axis=-1)
        gain = pattern(unit(where).reshape(-1, 3), self.config).reshape(distance.shape) ** 2
        amplitude = scatterer_gain(self.config) * gain * np.sqrt(section) / np.maximum(distance, 0.1) ** 2 * phase
        if room is not None:
            amplitude = amplitude * room.is_clear(np.zeros(3), where, ROOM_MARGIN_M)
        return Paths.of(
            amplitude.reshape(-1, len(section)), motion.reshape(-1, len(section), 3, 3),
            motion.reshape(-1, len(section), 3, 3), Interaction.THING,
        )  # fmt: skip

    def truth(self, frame_time_s: np.ndarray) -> tuple[ThingTruth, ...]:
        """Ground truth of each thing at times (frame,) in seconds, in the radar's frame."""
        found, step_s = [], 1e-3
        for thing in self.things:
            before, place, after = (
                self.pose.seen(thing.middle_m(frame_time_s + late)) for late in (-step_s, 0.0, step_s)
            )
            velocity = (after - before) / (2 * step_s)
            found.append(ThingTruth(kind=thing.thing.kind, place_m=place, velocity_mps=velocity, facts=thing.facts()))
        return tuple(found)


def reflector_paths(reflectors: Sequence[Reflector], pose: RadarPose, config: RadarConfig) -> StaticPaths:
    """Echoes of reflectors by the radar equation.

    Args:
        reflectors: Targets in the camera's level frame; corners and plates face the camera.
        pose: Pose of the radar.
        config: The radar.

    Returns:
        Static paths (reflector,), amplitudes in sqrt(mW).
    """
    level = np.array([one.place_m for one in reflectors], float).reshape(-1, 3)
    place = pose.seen(level)
    distance = np.linalg.norm(place, axis=1)
    away = np.degrees(np.arccos(np.clip((unit(level) * unit(level - pose.position_m)).sum(axis=1), -1, 1)))
    loss = np.array([_reflector_loss_db(*pair, config) for pair in zip(reflectors, away, strict=True)])
    section = 10 ** ((np.array([one.dbsm for one in reflectors]) - loss) / 10)
    gain = scatterer_gain(config) * pattern(unit(place), config) ** 2
    return scattered_paths(place, gain * np.sqrt(section) / np.maximum(distance, 0.05) ** 2, Interaction.TARGET, config)


def _reflector_loss_db(reflector: Reflector, off_axis_deg: float, config: RadarConfig) -> float:
    """Loss relative to the axis, from the direction of a radar that is not there."""
    if reflector.shape == "sphere":
        return 0.0
    if reflector.shape == "corner":
        return min(3.0 * (off_axis_deg / CORNER_HALF_POWER_DEG) ** 2, 40.0)
    side_m = (10 ** (reflector.dbsm / 10) * config.wavelength_m**2 / (4 * np.pi)) ** 0.25
    lobe = np.sinc(2 * side_m / config.wavelength_m * np.sin(np.radians(off_axis_deg)))
    return float(min(-20 * np.log10(max(abs(lobe), 1e-3)), 60.0))
