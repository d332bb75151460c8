"""How boards, rooms and recordings differ from what a task file says: conditions to score generated strangers in.

A condition changes how strangers are generated (their recipe), what is recorded of them (their points), or both.
`CONDITIONS` lists those of `recognised_elsewhere`; none trains a recogniser.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.records import PointCloud
from mmweaver.core.seeding import stream
from mmweaver.recognition.generated_sequences import SequenceRecipe
from mmweaver.recognition.point_recordings import PointRecording, is_moving
from mmweaver.signal.firmware_cfar import counts_per_db

COLUMNS = ("x_m", "y_m", "z_m", "radial_velocity_mps", "snr_db")
STEP_MPS = 0.12  # of the velocities of things that move
BESIDE_M = (1.1, 3.0, 0.3)  # where these are: right, ahead, up
Changed = Callable[[PointRecording, np.random.Generator], PointRecording]
Recipe = Callable[[SequenceRecipe], SequenceRecipe]


@dataclass(frozen=True, kw_only=True)
class Condition:
    """What differs from what the task says; None: nothing."""

    name: str
    recipe: Recipe | None = None  # of the strangers
    points: Changed | None = None  # that are recorded of them
    empty_place: bool = False  # whether the recogniser has a recording of the place with nobody in it

    def recorded(self, strangers: Sequence[PointRecording], seed: int) -> list[PointRecording]:
        """What is recorded of strangers under this condition."""
        change = self.points or (lambda recording, _: recording)
        return [change(one, stream(seed, "condition", self.name, one.name)) for one in strangers]


def _with_cloud(recording: PointRecording, **columns: np.ndarray) -> PointRecording:
    return replace(recording, cloud=replace(recording.cloud, **columns))


def _kept(recording: PointRecording, which: np.ndarray) -> PointRecording:
    return replace(recording, cloud=recording.cloud.select(which))


def _joined(recording: PointRecording, other: PointCloud) -> PointRecording:
    """The points of both, in the order of frames."""
    names = ("frame", *COLUMNS)
    columns = {name: np.concatenate([getattr(recording.cloud, name), getattr(other, name)]) for name in names}
    order = np.argsort(columns["frame"], kind="stable")
    return replace(recording, cloud=PointCloud(**{name: column[order] for name, column in columns.items()}))


# what is recorded ---------------------------------------------------------------------------------------------------
def capped(most: int) -> Changed:
    """At most so many points a frame, those nearest first: firmware lists objects by range."""

    def change(recording: PointRecording, _: np.random.Generator) -> PointRecording:
        cloud = recording.cloud
        order = np.lexsort([np.hypot(cloud.x_m, cloud.y_m), cloud.frame])
        frame = cloud.frame[order]
        place = np.arange(len(frame)) - np.searchsorted(frame, frame)
        return _kept(recording, np.sort(order[place < most]))

    return change


def fewer_frames(share: float) -> Changed:
    """This share of the frames is lost, and their numbers with them where `_renumbered` follows."""

    def change(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
        lost = rng.random(recording.num_frames) < share
        return _kept(recording, ~lost[recording.cloud.frame])

    return change


def every_other_frame(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """Recorded at half the rate that is said."""
    even = _kept(recording, recording.cloud.frame % 2 == 0)
    return replace(_with_cloud(even, frame=even.cloud.frame // 2), num_frames=recording.num_frames // 2)


def numbered_without_empty(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
    """A tenth of the frames is lost, and frames are counted as they come."""
    kept = fewer_frames(0.1)(recording, rng)
    occupied, number = np.unique(kept.cloud.frame, return_inverse=True)
    return replace(_with_cloud(kept, frame=number), num_frames=max(len(occupied), 1))


def without_static(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """Static clutter was removed, though the configuration says that it was not."""
    return _kept(recording, is_moving(recording.cloud))


def noisy_places(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
    """Directions of a board that is not calibrated: 4 degrees of noise in azimuth, 8 in elevation, per point."""
    cloud = recording.cloud
    across, up = np.radians([4.0, 8.0])
    x, y, z = cloud.x_m, cloud.y_m, cloud.z_m
    azimuth = np.arctan2(x, y) + across * rng.normal(size=len(x))
    range_m = np.sqrt(x**2 + y**2 + z**2)
    elevation = np.arcsin(np.clip(z / np.maximum(range_m, 1e-6), -1, 1)) + up * rng.normal(size=len(x))
    flat = range_m * np.cos(elevation)
    x, y, z = flat * np.sin(azimuth), flat * np.cos(azimuth), range_m * np.sin(elevation)
    return _with_cloud(recording, x_m=x, y_m=y, z_m=z)


def moving_object(
    *, most_points: int, fastest_mps: float, share: float, at: tuple[float, float] | None = None
) -> Changed:
    """Something that moves in one place, in a share of the frames; `at`: its range in m and azimuth in rad."""

    def change(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
        frames = recording.num_frames
        frame = np.repeat(np.arange(frames), rng.integers(1, most_points + 1, frames) * (rng.random(frames) < share))
        radius_m = 0.15 * rng.normal(size=(3, len(frame)))
        velocity = np.round(rng.uniform(-fastest_mps, fastest_mps, len(frame)) / STEP_MPS) * STEP_MPS
        moving = PointCloud(
            frame=frame, x_m=BESIDE_M[0] + radius_m[0], y_m=BESIDE_M[1] + radius_m[1], z_m=BESIDE_M[2] + radius_m[2],
            radial_velocity_mps=velocity, snr_db=np.full(len(frame), 15.0),
        )  # fmt: skip
        return _joined(recording, moving)

    return change


FAN = moving_object(most_points=4, fastest_mps=0.9, share=0.7)  # its blades have any velocity
CURTAIN = moving_object(most_points=3, fastest_mps=0.25, share=0.5)  # slowly to and fro


def furnished(objects: int) -> Changed:
    """More static points, one of each object: of most in nearly every frame, of some in few; all around, to 9 m."""

    def change(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
        share = rng.choice([1.0, 0.98, 0.9, 0.6, 0.3, 0.1], objects, p=[0.3, 0.2, 0.2, 0.1, 0.1, 0.1])
        frame, which = np.nonzero(rng.random((recording.num_frames, objects)) < share)
        range_m, azimuth, up_m = (
            rng.uniform(0.3, 9.0, objects),
            rng.uniform(-1.1, 1.1, objects),
            rng.normal(0, 0.5, objects),
        )
        azimuth = azimuth[which] + 0.03 * rng.normal(size=len(which))
        still = PointCloud(
            frame=frame, x_m=range_m[which] * np.sin(azimuth), y_m=range_m[which] * np.cos(azimuth), z_m=up_m[which],
            radial_velocity_mps=np.zeros(len(frame)), snr_db=np.full(len(frame), 17.0),
        )  # fmt: skip
        return _joined(recording, still)

    return change


def with_ghost(recording: PointRecording, rng: np.random.Generator) -> PointRecording:
    """An echo of the body over a wall: some of its points again, farther away and on another side."""
    body = recording.cloud.select(is_moving(recording.cloud) & (rng.random(len(recording.cloud.frame)) < 0.5))
    farther, turn = rng.uniform(1.3, 1.8), rng.choice([-1.0, 1.0]) * rng.uniform(0.2, 0.7)
    cos, sin = np.cos(turn), np.sin(turn)
    x, y = farther * (body.x_m * cos - body.y_m * sin), farther * (body.x_m * sin + body.y_m * cos)
    return _joined(recording, replace(body, x_m=x, y_m=y))


def empty_place(seconds: float, rate_hz: float) -> PointRecording:
    """A recording of a place in which nothing is and nobody; conditions add what moves there."""
    columns = dict.fromkeys(COLUMNS, np.zeros(0))
    return PointRecording(
        name="empty place", cloud=PointCloud(frame=np.zeros(0, int), **columns),
        num_frames=round(seconds * rate_hz), frame_rate_hz=rate_hz,
    )  # fmt: skip


# how strangers are generated -----------------------------------------------------------------------------------------
def _threshold(by_db: float) -> Recipe:
    def change(recipe: SequenceRecipe) -> SequenceRecipe:
        firmware, antennas = recipe.task.firmware, recipe.task.radar.num_antennas
        counts = round(by_db * counts_per_db(firmware.device, antennas))
        high, low = (
            None if cfar is None else replace(cfar, threshold=max(cfar.threshold + counts, 0))
            for cfar in (firmware.range_cfar, firmware.doppler_cfar)
        )
        return _with_firmware(recipe, range_cfar=high, doppler_cfar=low)

    return change


def _with_firmware(recipe: SequenceRecipe, **values: object) -> SequenceRecipe:
    return replace(recipe, task=replace(recipe.task, firmware=replace(recipe.task.firmware, **values)))


def _averaged(mode: str) -> Recipe:
    def change(recipe: SequenceRecipe) -> SequenceRecipe:
        cfar = recipe.task.firmware.range_cfar
        return recipe if cfar is None else _with_firmware(recipe, range_cfar=replace(cfar, average=mode))

    return change


def _varied(**spans: object) -> Recipe:
    return lambda recipe: replace(recipe, variation=replace(recipe.variation, **spans))


def _faster_chirps(recipe: SequenceRecipe) -> SequenceRecipe:
    """Velocities up to twice as high, in steps twice as large: another .cfg than the one that is named."""
    radar = recipe.task.radar
    faster = replace(radar, idle_time_s=radar.chirp_period_s / 2 - radar.ramp_end_time_s)
    return replace(recipe, task=replace(recipe.task, radar=faster))


def mirrored(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """The board hangs upside down, and nobody said so."""
    return _with_cloud(recording, x_m=-recording.cloud.x_m, z_m=-recording.cloud.z_m)


def signs_flipped(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """Velocities towards the radar are positive, and nobody said so."""
    return _with_cloud(recording, radial_velocity_mps=-recording.cloud.radial_velocity_mps)


def axes_swapped(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """x and y are named the other way round."""
    return _with_cloud(recording, x_m=recording.cloud.y_m, y_m=recording.cloud.x_m)


def without_snr(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """No strength is recorded."""
    return _with_cloud(recording, snr_db=np.full(len(recording.cloud.frame), np.nan))


def in_tenths(recording: PointRecording, _: np.random.Generator) -> PointRecording:
    """Strengths in tenths of a decibel, as the demo sends them."""
    return _with_cloud(recording, snr_db=10 * recording.cloud.snr_db)


CONDITIONS = (
    Condition(name="as generated"),
    Condition(name="no SNR", points=without_snr),
    Condition(name="SNR in 0.1 dB", points=in_tenths),
    Condition(name="16 points a frame at most", points=capped(16)),
    Condition(name="thresholds 6 dB higher", recipe=_threshold(6.0)),
    Condition(name="thresholds 6 dB lower", recipe=_threshold(-6.0)),
    Condition(name="CFAR averages both sides", recipe=_averaged("ca")),
    Condition(name="CFAR takes the greater side", recipe=_averaged("cago")),
    Condition(name="neighbours not grouped", recipe=lambda recipe: _with_firmware(
        recipe, group_range=False, group_doppler=False)),
    Condition(name="neighbours not grouped, no SNR", recipe=lambda recipe: _with_firmware(
        recipe, group_range=False, group_doppler=False), points=without_snr),
    Condition(name="30 % of the frames lost", points=fewer_frames(0.3)),
    Condition(name="a tenth of the frames lost, not counted", points=numbered_without_empty),
    Condition(name="static clutter removed", points=without_static),
    Condition(name="directions noisy", points=noisy_places),
    Condition(name="board 2 to 3 m high", recipe=_varied(radar_height_m=(2.0, 3.0))),
    Condition(name="board 2 to 3 m high that looks down 20 to 40 degrees", recipe=_varied(
        radar_height_m=(2.0, 3.0), tilt_deg=(20.0, 40.0))),
    Condition(name="clutter 10 dB stronger", recipe=_varied(clutter_db=(10.0, 20.0))),
    Condition(name="three times as much furniture", recipe=_varied(most_panels=27)),
    Condition(name="clutter of a hall", recipe=_varied(clutter_db=(20.0, 30.0), most_panels=27)),
    Condition(name="25 static points more", points=furnished(25)),
    Condition(name="people 3 to 5 m away", recipe=_varied(
        distance_m=(3.0, 5.0), near_m=(1.5, 3.0), far_m=(4.0, 5.5), wall_m=(5.5, 8.0))),
    Condition(name="fan", points=FAN),
    Condition(name="fan, the empty place recorded", points=FAN, empty_place=True),
    Condition(name="curtain", points=CURTAIN),
    Condition(name="curtain, the empty place recorded", points=CURTAIN, empty_place=True),
    Condition(name="ghost of the body behind a wall", points=with_ghost),
    Condition(name="half the frame rate, not said", points=every_other_frame),
    Condition(name="chirps twice as fast, not said", recipe=_faster_chirps),
    Condition(name="velocity towards the radar positive, not said", points=signs_flipped),
    Condition(name="board upside down, not said", points=mirrored),
    Condition(name="x and y swapped, not said", points=axes_swapped),
)  # fmt: skip
