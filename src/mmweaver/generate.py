"""The front door: photo and sentence in, radar signal out. Read this file first.

    photo + depth --scene--> Scene --------------------+
                               |                       +--method--> RadarCube --dsp--> PointCloud
    sentences -----motion--> PoseSequences, placed ----+

Only this file knows the order of the rooms; they exchange the records of `core/records.py` and nothing else.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.presets import PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import AdcCube, PointCloud, PoseSequence, RadarCube, RgbdPhoto, Scene
from mmweaver.core.skeleton import joint
from mmweaver.core.stages import Stages
from mmweaver.core.version import __version__
from mmweaver.dsp.detection import check_points, detect
from mmweaver.figures.figure_data import FigureData
from mmweaver.formats.radar_file import load_firmware, load_radar
from mmweaver.methods import DEFAULT_METHOD, METHODS, Learned
from mmweaver.motion.animation.resample import resample
from mmweaver.motion.compose import Motion
from mmweaver.motion.language.timing import plan_motion
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_placement import place_clip
from mmweaver.motion.mocap.clip_resampling import check_lasts
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.motion.multi_person import MOST_PEOPLE, Place, compose_people
from mmweaver.result_folder import META_VERSION, file_digest, radar_meta, save_results
from mmweaver.scene.affordances.landmarks import with_given_landmarks
from mmweaver.scene.photo.capture_photo import read_capture_photo
from mmweaver.scene.read_photo import classes_of, read_photo
from mmweaver.scene.reconstruction import reconstruct
from mmweaver.scene.sample_photo import sample_photo

MAX_FRAMES = 2000
FPS_LIMITS = (0.1, 1000.0)
MAX_SECONDS = 600.0
MAX_BYTES = 2_000_000_000  # of the largest array


# rooms and results --------------------------------------------------------------------------------------------------
@dataclass(frozen=True, kw_only=True)
class Room:
    """A photo, read and reconstructed; reused for as many sentences as wanted."""

    scene: Scene
    inputs: dict[str, Any]
    seconds: dict[str, float]

    def with_landmarks(self, *told: tuple[str, Place]) -> "Room":
        """The room with things at places that you know: `("door", (0.9, 2.8))`, metres right of and ahead of the radar.

        They take the place of what was found of that kind. Raises InputError for what no sentence goes to.
        """
        inputs = self.inputs | {"landmarks": [[kind, *place] for kind, place in told]}
        return replace(self, scene=with_given_landmarks(self.scene, told), inputs=inputs)

    def with_empty_recording(self, source: str | Path | RadarCube, *, came_from: Path | None = None) -> "Room":
        """The room with a recording of it by your radar, nobody there: what rests is taken from that, phases and all.

        `source`: a folder of `mmweaver process`, its radar.npz, a capture folder, or the cube (`came_from`: its file or
        folder, for meta.json). Only the network takes it. Raises InputError for what is no recording.
        """
        if not isinstance(source, RadarCube):
            from mmweaver.recordings.captures import recorded_cube

            came_from = Path(source)
            source = recorded_cube(came_from)
        inputs = self.inputs if came_from is None else self.inputs | {"empty_room": _origin(came_from)}
        return replace(self, scene=replace(self.scene, empty_recording=source), inputs=inputs)


@dataclass(frozen=True, kw_only=True)
class Generation:
    """One generated sequence. `poses` hold each person's joints at the radar's frames, `motions` densely in time."""

    cube: RadarCube
    points: PointCloud
    adc: AdcCube | None
    poses: tuple[PoseSequence, ...]
    motions: tuple[PoseSequence, ...]
    scene: Scene
    meta: dict[str, Any]
    stages: Stages = field(repr=False)

    @property
    def pose(self) -> PoseSequence:
        """The first person's joints at the radar's frames."""
        return self.poses[0]

    @property
    def motion(self) -> PoseSequence:
        """The first person's joints densely in time."""
        return self.motions[0]

    @property
    def photo(self) -> RgbdPhoto:
        return self.scene.photo

    def save(
        self, out: str | Path, *, overwrite: bool = False, adc_data_bin: bool = False, iq_order: str = "iq",
        pictures: bool = True,
    ) -> dict[str, Any]:  # fmt: skip
        """Writes all files and pictures into a folder, or none of them; returns what meta.json holds.

        Without `pictures` the files alone, much quicker. `adc_data_bin` asks for the raw samples too, as a DCA1000
        writes them, I or Q first. Raises InputError where the folder cannot be written, or holds other files and
        `overwrite` is not set.
        """
        if adc_data_bin and self.adc is None:
            raise InputError(
                "there are no ADC samples to write; generate with keep_adc=True and a method that has them"
            )
        view = FigureData(
            title=f"{' | '.join(texts_of(self.meta['text']))}   ({self.cube.config.name}, seed {self.meta['seed']})",
            cube=self.cube, points=self.points, photo=self.photo, radar_from_camera=self.scene.radar_from_camera,
            poses=self.poses, motions=self.motions,
        )  # fmt: skip
        return save_results(
            out, view, self.meta, adc=self.adc if adc_data_bin else None, iq_order=iq_order, overwrite=overwrite,
            stages=self.stages, pictures=pictures,
        )  # fmt: skip


# the door -----------------------------------------------------------------------------------------------------------
class Weaver:
    """Generates radar signals with one method and one radar.

    `method` is a name in METHODS: "weaver", the network, "physics", or "auto", the network for all that it can make,
    which is all but raw ADC samples, several people, and frames of long chirps (see `methods.Auto`). `radar` is a
    preset's name, a TI .cfg or radar.json file, or a RadarConfig. `listener` hears the name of each stage as it begins.
    `points` chooses the point cloud: "cfar", this project's own, or "firmware", that of TI's demo, which needs ADC
    samples; `firmware` are its settings (default: what the radar's .cfg or preset says).
    `weights`: a file or folder of `mmweaver train`, or a Hub name, for the network, which then makes all signals;
    `from_pretrained` is the short way. Raises InputError for what is not known.
    """

    def __init__(
        self,
        method: str = DEFAULT_METHOD,
        radar: str | Path | RadarConfig = "awr1843",
        *,
        listener: Callable[[str], object] | None = None,
        points: str = "cfar",
        firmware: FirmwareSettings | None = None,
        weights: str | Path | None = None,
    ):
        if weights is not None and method not in ("weaver", DEFAULT_METHOD):
            raise InputError(f"weights are for the method 'weaver', not {method!r}; leave them out")
        self.method_name = method if weights is None else "weaver"
        file = None if weights is None else _found(weights)
        self.method = METHODS[method]() if file is None else Learned(file)
        self.weights = None if file is None else file_digest(file)
        self.radar = radar if isinstance(radar, RadarConfig) else load_radar(str(radar))
        self._listener = listener
        check_points(points, self.radar)
        self.points = points
        if points == "firmware" and firmware is None:
            firmware = FirmwareSettings() if isinstance(radar, RadarConfig) else load_firmware(str(radar))
        self.firmware = firmware

    @classmethod
    def from_pretrained(
        cls, source: str | Path, radar: str | Path | RadarConfig | None = None, *, revision: str | None = None,
        **options: Any,
    ) -> "Weaver":  # fmt: skip
        """A weaver whose signals a trained network writes.

        `source`: a weight file, a folder of `mmweaver train`, or a name on the Hub (`revision`: which of its versions).
        `radar` defaults to the one it was trained for; `options` as for the class. Raises InputError for files that are
        damaged, foreign or of another version.
        """
        from mmweaver.models.weights import read_card

        file = _found(source, revision)
        trained_for = read_card(file).radar
        return cls("weaver", radar or (trained_for if trained_for in PRESETS else "awr1843"), weights=file, **options)

    def read_room(
        self, rgb: str | Path, depth: str | Path | None = None, camera: str | Path | None = None, **seen: Any
    ) -> Room:
        """The room of a photo: a colour picture, its depth (16-bit PNG or .npy in metres) and the camera's JSON.

        `seen`: `depth_model` estimates a missing depth; `classes` (a picture of class numbers) or `segmenter` and
        `sam` (models) say what is what, so that materials follow from it. See `scene.read_photo.read_photo`.
        """
        stages = Stages(self._listener)
        with stages("read the photo"):
            photo, assumptions = read_photo(rgb, depth, camera, **seen)
            files = {"rgb": rgb, "depth": depth, "camera": camera, "classes": seen.get("classes")}
            inputs: dict[str, Any] = {name: file_digest(path) for name, path in files.items() if path is not None}
            models = ("depth_model", "segmenter", "sam")
            inputs |= {name: str(seen[name]) for name in models if seen.get(name) is not None}
        return self._reconstruct(photo, assumptions, inputs, stages)

    def read_capture(self, capture: str | Path, *, photo: int = 0, rgb: str | Path | None = None, **seen: Any) -> Room:
        """The room of one photo of a capture folder (mmwave-capture-std: a RealSense's color.avi and depth.zst).

        `rgb`: a picture that takes the place of the frame of color.avi, where that cannot be decoded. `seen`:
        `classes`, `segmenter` and `sam` as in `read_room`.
        """
        stages = Stages(self._listener)
        with stages("read the photo"):
            found = read_capture_photo(capture, photo, None if rgb is None else Path(rgb))
            given = {"depth": found.folder / "depth.zst", "rgb": rgb or found.folder / "color.avi"}
            inputs = {"photo": photo, **{name: file_digest(path) for name, path in given.items()}}
            inputs |= {name: str(source) for name, source in seen.items() if source is not None}
            whole = replace(found.photo, classes=classes_of(found.photo, **seen))
        return self._reconstruct(whole, found.assumptions, inputs, stages)

    def sample_room(self) -> Room:
        """The room that comes with the project."""
        stages = Stages(self._listener)
        with stages("read the photo"):
            photo, assumptions = sample_photo()
        return self._reconstruct(photo, assumptions, {"sample": "the bundled room"}, stages)

    @staticmethod
    def read_motion(
        path: str | Path,
        *,
        fps: float | None = None,
        unit: str | float | None = None,
        up: str | None = None,
        clip: str | None = None,
        body_model: str | Path | None = None,
    ) -> MotionClip:
        """A recorded motion for `generate`: BVH, AMASS/SMPL, HumanML3D, CMU or joints; see docs/motion_files.md."""
        return read_motion(path, fps=fps, unit=unit, up=up, clip=clip, body_model=body_model)

    @staticmethod
    def _reconstruct(photo: RgbdPhoto, assumptions: tuple[str, ...], inputs: dict[str, Any], stages: Stages) -> Room:
        with stages("reconstruct the room"):
            scene = reconstruct(photo, assumptions=assumptions)
        return Room(scene=scene, inputs=inputs, seconds=stages.seconds)

    def generate(
        self,
        room: Room,
        text: str | Sequence[str] | None = None,
        *,
        motion: MotionClip | None = None,
        frames: int = 20,
        fps: float | None = None,
        seed: int = 0,
        at: Place | Sequence[Place | None] | None = None,
        heading_rad: float | None = None,
        height_m: float | Sequence[float | None] | None = None,
        as_recorded: bool = False,
        keep_adc: bool = False,
    ) -> Generation:
        """The signal of who does in the room what the text says (one text a person), or what a `motion` shows.

        A `motion` comes from `read_motion` or a motion model; it is the first person's, and the first text only names
        it. `heading_rad` (from +x towards +y) is where its body faces first, `as_recorded` takes its places as the
        radar's own. `height_m` is the body's height, for several people a list; a recorded body is scaled to it.

        `fps` defaults to the radar's own frame rate (10 for the awr1843); `at` is where the person starts, (x right,
        y away from the radar) in metres, chosen if not given; for several texts a list of such places. People keep
        half a metre apart. `keep_adc` asks for the raw samples too, which take several times the cube's memory and,
        unless a method is named, make physics the method. The same seed gives the same bits. Raises
        InputError for a request that cannot be met.
        """
        needs_adc = keep_adc or self.points == "firmware"
        config = check_request(
            self.radar, text=text, motion=motion, frames=frames, fps=fps, seed=seed, at=at, keep_adc=needs_adc
        )
        duration_s = frames * config.frame_period_s
        window_m = (float(config.range_m[0]), float(config.range_m[-1]))
        stages = Stages(self._listener)
        stages.seconds.update(room.seconds)
        with stages("compose the motion"):
            texts, starts, heights = texts_of(text), places_of(text, at), heights_of(text, height_m)
            recorded = None
            if motion is not None:
                clip = motion if heights[0] is None else motion.scaled_to(heights[0])
                recorded = place_clip(
                    clip, room.scene, duration_s=duration_s, seed=seed, range_window_m=window_m,
                    start_m=starts[0], heading_rad=heading_rad, as_recorded=as_recorded,
                )  # fmt: skip
            plans = [
                plan_motion(one, duration_s) if motion is None or index else None for index, one in enumerate(texts)
            ]
            people = compose_people(
                plans, room.scene, seed=seed, range_window_m=window_m, starts_m=starts, heights_m=heights,
                first=recorded,
            )  # fmt: skip
        motions = tuple(person.pose for person in people)
        signal = self.method(
            room.scene, motions, config, num_frames=frames, seed=seed, keep_adc=needs_adc, stages=stages
        )
        with stages("point cloud"):
            points = detect(signal.cube, signal.adc, self.points, self.firmware)
        poses = tuple(resample(one, signal.cube.grid.frame_time_s) for one in motions)
        meta = {
            "schema_version": META_VERSION,
            "made_by": "mmweaver generate",
            "version": __version__,
            "text": people[0].plan.text if text is None else text if isinstance(text, str) else list(text),
            "seed": seed, "frames": frames, "fps": 1 / config.frame_period_s, "at": at,
            "method": signal.method or self.method_name,
            "weights": self.weights,
            "points": self.points,
            "firmware": self.firmware if self.points == "firmware" else None,
            **radar_meta(config),
            "inputs": room.inputs | _motion_input(motion),
            "placed": {"heading_rad": heading_rad, "height_m": height_m, "as_recorded": as_recorded},
            "camera": room.scene.photo.intrinsics,
            "assumed": _assumed(room.scene, people, signal.assumptions),
            **_people_meta(poses, people),
        }  # fmt: skip
        return Generation(
            cube=signal.cube, points=points, adc=signal.adc if keep_adc else None, poses=poses,
            motions=motions, scene=room.scene, meta=meta, stages=stages,
        )  # fmt: skip


def _found(weights: str | Path, revision: str | None = None) -> Path:
    from mmweaver.models.find_weights import find_weights

    return find_weights(weights, revision=revision)


def _origin(place: Path) -> dict[str, str]:
    """What meta.json says of a recording's file or folder."""
    file = next((one for one in (place, place / "radar.npz") if one.is_file()), None)
    return {"path": str(place)} if file is None else file_digest(file)


def _assumed(scene: Scene, people: tuple[Motion, ...], of_method: tuple[str, ...]) -> list[str]:
    of_motion = (
        sentence if len(people) == 1 else f"person {number}: {sentence}"
        for number, person in enumerate(people, 1) for sentence in person.assumptions
    )  # fmt: skip
    return list(dict.fromkeys((*scene.assumptions, *of_motion, *of_method)))


def _people_meta(poses: tuple[PoseSequence, ...], people: tuple[Motion, ...]) -> dict[str, Any]:
    """`person` and `plan` of one; `people`, a list of both, of several."""
    described = [{**_person(pose), "plan": person.plan} for pose, person in zip(poses, people, strict=True)]
    if len(described) > 1:
        return {"people": described}
    return {"person": _person(poses[0]), "plan": people[0].plan}


def _motion_input(motion: MotionClip | None) -> dict[str, Any]:
    """What meta.json says of a recorded motion."""
    if motion is None:
        return {}
    digest = {} if motion.file is None else file_digest(motion.file)
    return {"motion": {**digest, "name": motion.label, "fps": motion.fps, "first_frame": motion.first_frame}}


def _person(pose: PoseSequence) -> dict[str, Any]:
    path_m = np.round(pose.joints_m[:, joint("pelvis"), :2], 3)
    return {
        "height_m": pose.height_m,
        "starts_at_m": path_m[0],
        "ends_at_m": path_m[-1],
        "path_length_m": round(float(np.linalg.norm(np.diff(path_m, axis=0), axis=1).sum()), 3),
    }


def texts_of(text: str | Sequence[str] | None) -> list[str]:
    """One text a person. Raises InputError for none or too many."""
    texts = [text or ""] if text is None or isinstance(text, str) else list(text)
    if not 1 <= len(texts) <= MOST_PEOPLE:
        raise InputError(f"give 1 to {MOST_PEOPLE} texts, one for each person, not {len(texts)}")
    return texts


def places_of(text: str | Sequence[str] | None, at: Place | Sequence[Place | None] | None) -> list[Place | None]:
    """Where each person starts, None = chosen. Raises InputError for what is no place, or more places than people."""
    one = at is not None and all(isinstance(value, int | float) for value in at)
    given: list[Any] = [] if at is None else [at] if one else list(at)
    texts = texts_of(text)
    if len(given) > len(texts) or (one and len(texts) > 1):
        raise InputError(f"{len(texts)} people need a list of at most {len(texts)} places to start, not {at}")
    for place in given:
        if place is not None and not (len(place) == 2 and all(math.isfinite(value) for value in place)):
            raise InputError(f"the place to start must be two numbers, x and y in metres, not {place}")
    return [(float(place[0]), float(place[1])) if place else None for place in given] + [None] * (
        len(texts) - len(given)
    )


def heights_of(text: str | Sequence[str] | None, height_m: float | Sequence[float | None] | None) -> list[float | None]:
    """Each person's height, None = drawn. Raises InputError for more heights than people."""
    given = [height_m] if height_m is None or isinstance(height_m, int | float) else list(height_m)
    texts = texts_of(text)
    if len(given) > len(texts):
        raise InputError(f"{len(texts)} people need at most {len(texts)} heights, not {len(given)}")
    if len(given) == 1 and given[0] is not None and len(texts) > 1 and isinstance(height_m, int | float):
        raise InputError(f"{len(texts)} people need a list of heights, one for each (--height for each)")
    return [None if height is None else float(height) for height in given] + [None] * (len(texts) - len(given))


def check_request(
    radar: RadarConfig,
    *,
    text: str | Sequence[str] | None = None,
    motion: MotionClip | None = None,
    frames: int = 20,
    fps: float | None = None,
    seed: int = 0,
    at: Place | Sequence[Place | None] | None = None,
    keep_adc: bool = False,
) -> RadarConfig:
    """The radar at the frame rate asked for; cheap, so that it can be asked before long work.

    Raises InputError for texts, frames, fps or a place out of their limits, for a frame rate that the chirps do not
    fit into, for more samples than memory holds, for a text that is not understood or does not fit the time, and for a
    recorded motion that is too short.
    """
    if not 1 <= frames <= MAX_FRAMES:
        raise InputError(f"frames must be 1 to {MAX_FRAMES}, not {frames}")
    if fps is not None and not FPS_LIMITS[0] <= fps <= FPS_LIMITS[1]:
        raise InputError(f"fps must be {FPS_LIMITS[0]:g} to {FPS_LIMITS[1]:g}, not {fps:g}")
    if seed < 0:
        raise InputError(f"the seed must be 0 or above, not {seed}")
    texts = texts_of(text)
    places_of(text, at)
    config = radar if fps is None else replace(radar, frame_period_s=1 / fps)
    if frames * config.frame_period_s > MAX_SECONDS:
        raise InputError(
            f"{frames} frames last {frames * config.frame_period_s:g} s; at most {MAX_SECONDS:g} s are made"
        )
    numbers = config.num_loops * config.num_antennas * (config.num_samples if keep_adc else config.num_range_bins)
    most = MAX_BYTES // (8 * numbers)
    if frames > most:
        raise InputError(
            f"{frames} frames of radar {config.name!r} fill {frames * 8 * numbers / 1e9:.1f} GB of memory; at most"
            f" {most} are made at a time"
        )
    if motion is not None:
        check_lasts(motion, frames * config.frame_period_s)
    for one in texts[0 if motion is None else 1 :]:
        plan_motion(one, frames * config.frame_period_s, 1 / config.frame_period_s)
    return config
