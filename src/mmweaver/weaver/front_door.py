"""The front door: photo and sentence in, radar signal out. Read this file first.

    photo + depth --scene--> Scene --------------------+
                               |                       +--method--> RadarCube --dsp--> PointCloud
    sentences -----motion--> PoseSequences, placed ----+

Only this file knows the order of the packages; they exchange the records of `core/records.py` and nothing else.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board
from mmweaver.core.boards import IDEAL_BOARD, compensated
from mmweaver.core.channel_calibration import ChannelCalibration
from mmweaver.core.default_precision import single_precision
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.options import keywords_of
from mmweaver.core.presets import PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import AT_CAMERA
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.skeleton import joint
from mmweaver.core.stages import Stages
from mmweaver.core.version import __version__
from mmweaver.evaluation.background_board import BackgroundBoard
from mmweaver.io.radar_file import load_firmware, load_radar
from mmweaver.io.result_folder import META_VERSION, file_digest
from mmweaver.io.ti_calibration import read_ti_calibration
from mmweaver.models.methods import DEFAULT_METHOD, METHODS, Learned, Method, Signal
from mmweaver.motion.animation.resample import resample
from mmweaver.motion.compose import Motion
from mmweaver.motion.continuous import ContinuousMotion
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.clip_placement import place_clip
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.motion.multi_person import compose_people
from mmweaver.motion.people import subject_of
from mmweaver.motion.planning.placement import Conditions
from mmweaver.propagation.static_paths import ALL_PATHS
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from, unseen_notes
from mmweaver.signal.detection import check_points, detect, needs_adc
from mmweaver.weaver.generation import Generation, Room
from mmweaver.weaver.parsed_request import ParsedRequest, parse
from mmweaver.weaver.request import Request
from mmweaver.weaver.room_reader import RoomReader
from mmweaver.weaver.streaming import (
    CHUNK_FRAMES,
    StreamChunk,
    Streamer,
    check_streams,
    takes_argument,
)


class Weaver(RoomReader):
    """Generates radar signals with one method and one radar.

    `method` is an object that follows `methods.Method`, or a name in METHODS: "weaver", the network (the default, also
    called "auto"), or "physics". `radar` is a preset's name, a TI .cfg or radar.json file, or a RadarConfig. `listener`
    is called with the name of each stage as it begins.
    `points` chooses the point cloud: "cfar", this project's own, "firmware", that of TI's demo, which needs ADC
    samples, or a registered detector; `firmware` are the settings of TI's (default: what the radar's .cfg or preset
    says).
    `calibration`: the channel errors that the radar's firmware compensates (default: those of its .cfg); ADC samples
    are then as that board records them, cube and points as it compensates them. `weights`: a file or folder of
    `mmweaver train`, or a Hub name, for the network, which then makes all signals;
    `from_pretrained` is the short form. Raises InputError for unknown names.
    """

    def __init__(
        self,
        method: str | Method = DEFAULT_METHOD,
        radar: str | Path | RadarConfig = "awr1843",
        *,
        listener: Callable[[str], object] | None = None,
        points: str = "cfar",
        firmware: FirmwareSettings | None = None,
        weights: str | Path | None = None,
        calibration: ChannelCalibration | None = None,
    ):
        if weights is not None and method not in ("weaver", DEFAULT_METHOD):
            raise InputError(f"weights are for the method 'weaver', not {method!r}; leave them out")
        file = None if weights is None else _found(weights)
        self.method: Method
        if not isinstance(method, str):
            self.method_name = str(getattr(method, "__name__", type(method).__name__))
            self.method = method
        else:
            self.method_name = method if file is None else "weaver"
            self.method = METHODS[method]() if file is None else Learned(file)
        self.weights = None if file is None else file_digest(file)
        self.radar = radar if isinstance(radar, RadarConfig) else load_radar(str(radar))
        is_named = not isinstance(radar, RadarConfig)
        self.calibration = read_ti_calibration(str(radar)) if calibration is None and is_named else calibration
        super().__init__(listener)
        self._background_board = BackgroundBoard()
        check_points(points, self.radar)
        self.points = points
        if points == "firmware" and firmware is None:
            firmware = FirmwareSettings() if isinstance(radar, RadarConfig) else load_firmware(str(radar))
        self.firmware = firmware

    @classmethod
    def from_pretrained(
        cls,
        source: str | Path,
        radar: str | Path | RadarConfig | None = None,
        *,
        revision: str | None = None,
        **options: Any,
    ) -> "Weaver":
        """A weaver that uses a trained network.

        `source`: a weight file, a folder of `mmweaver train`, or a name on the Hub, at a `revision`.
        `radar` defaults to the one it was trained for; `options` as for the class. Raises InputError for files that are
        damaged, foreign or of another version.
        """
        from mmweaver.models.weights import read_card

        file = _found(source, revision)
        trained_for = read_card(file).radar
        return cls("weaver", radar or (trained_for if trained_for in PRESETS else "awr1843"), weights=file, **options)

    @property
    def is_standard(self) -> bool:
        """Whether METHODS gives, by the name alone, a method that makes the same signals."""
        if self.weights is not None or self.method_name not in METHODS:
            return False
        return getattr(self.method, "propagation", ALL_PATHS) == ALL_PATHS

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

    @keywords_of(Request, "text")
    def request(self, text: str | Sequence[str] | None = None, **asked: Any) -> ParsedRequest:
        """A checked and parsed request, with the arguments of `generate`. Cheap: no room is needed.

        Raises:
            InputError: for a request that cannot be met.
        """
        return self.parsed(Request(text=text, **asked))

    def parsed(self, request: Request) -> ParsedRequest:
        """The same of a record. Raises InputError for a request that cannot be met."""
        return parse(request, self.radar, needs_adc=needs_adc(self.points))

    @keywords_of(Request, "text")
    def generate(self, room: Room, text: str | Sequence[str] | None = None, **asked: Any) -> Generation:
        """The signal of people doing in the room what the text says, or what a recorded motion shows.

        The sentence decides how long it takes (at least two seconds), and a recorded motion lasts as long as it is;
        `frames` or `seconds` fix it: a sentence is then fitted, repeated or cut, which `meta` says. People keep half a
        metre apart. The same seed gives the same bits.

        Args:
            room: of `read_room`, `open_room` or `sample_room`; used as often as you like.
            text: what the person does, or a list with a text for each person; "nobody" alone: the room is empty.
            motion: a recorded motion of `read_motion` or a motion model for the first person, whose text names it.
            frames, seconds: how many radar frames, or how long (default: as the sentence needs).
            fps: frames per second (default: the radar's own, 10 for the awr1843).
            seed: of everything that is sampled.
            at: where the person starts, (x right, y away from the radar) in metres; chosen if not given.
            heading_rad: where the first body faces first, from +x towards +y.
            path_m: corners (x, y) of the first person's walk.
            height_m: the body's height; a recorded body is scaled to it.
            subject: the person by number, 0 to 9999: skin, build, habits, usual height; by default sampled by the seed.
            as_recorded: a motion's positions are the radar's own.
            keep_adc: also return raw samples, several times the cube's memory; the cube is the same without.
            board: whose errors the signal has: "typical" (sampled by the seed; the default, but with a background the
                one that recorded it), "typical:N", "ideal", a board.json or a `Board` (docs/board.md).
            radar_poses: a `RadarPose` for each radar that records the scene (default: one at the camera).

        Of several people `at`, `height_m` and `subject` are lists.

        Raises:
            InputError: for a request that cannot be met.
        """
        return self.carry_out(self.request(text, **asked), room)

    def stream(
        self, room: Room, sentences: Iterable[str | None], *, chunk_frames: int = CHUNK_FRAMES, **asked: Any
    ) -> Iterator[StreamChunk]:
        """The signal of one person who does what one sentence after the other says, without a break between them.

        Each sentence begins where the person is, in the posture that they are in, and takes as long as it needs; its
        last chunk may have fewer than `chunk_frames` frames. A sentence that is not understood, or has no room, is
        skipped and reported in `StreamChunk.refused`; for the first it is an InputError. The same seed and sentences
        give the same bits, whatever `chunk_frames` is, unless sentences are None, each of which lasts a chunk. Memory
        does not grow with the length of the stream.

        Args:
            room: as for `generate`.
            sentences: any iterable, a live one too: it is asked for the next sentence when the last is done. None or ""
                says that there is nothing new: one more chunk of the last activity, or of holding the posture.
            chunk_frames: radar frames of a chunk.
            asked: `seed`, `at`, `heading_rad`, `height_m`, `subject`, `fps`, `keep_adc` and `board` as for `generate`.

        Raises:
            InputError: for a request that cannot be met.
        """
        check_streams(self.method, self.method_name)
        request = self.request("a person stands", frames=1, **asked)
        (person,) = request.people
        motion = ContinuousMotion(
            room.scene,
            Conditions(seed=request.seed, start_m=person.start_m, heading_rad=request.heading_rad),
            frame_period_s=request.config.frame_period_s,
            range_window_m=request.range_window_m,
            farthest_m=request.config.farthest_bin_m,
            height_m=person.height_m,
            subject=person.subject,
        )
        return Streamer(self, room, request, motion, chunk_frames).chunks(sentences)

    @single_precision()
    def carry_out(self, request: ParsedRequest, room: Room, people: tuple[Motion, ...] | None = None) -> Generation:
        """What `generate` does with a request that is already parsed, or whose motions are composed already (`people`).

        Raises InputError where the room has no place.
        """
        poses = request.radar_poses or (AT_CAMERA,)
        if room.background is not None and len(poses) > 1:
            raise InputError("a background recording is of one radar; give one radar pose, that of the recording")
        scenes = [scene_seen_from(room.scene, pose) for pose in poses]
        stages = Stages(self._listener)
        stages.seconds.update(room.seconds)
        with stages("compose the motion"):
            people = compose_request(request, room.scene) if people is None else people
        results = [self._recorded(request, replace(room, scene=scene), people, stages) for scene in scenes]
        return replace(results[0], further=tuple(results[1:]))

    def _recorded(self, request: ParsedRequest, room: Room, people: tuple[Motion, ...], stages: Stages) -> Generation:
        """What one radar records; `room` is in its frame, the people in the camera's."""
        pose = room.scene.radar_pose
        motions = people_seen_from(tuple(person.pose for person in people), pose)
        board, given = self.board_of(replace(request, seed=pose.noise_seed(request.seed)), room)
        signal = self.method(
            room.scene,
            motions,
            request.config,
            num_frames=request.frames,
            seed=request.seed,
            keep_adc=request.keep_adc or needs_adc(self.points),
            stages=stages,
            background=room.background,
            **given,
        )
        with stages("point cloud"):
            points = detect(signal.cube, signal.adc, self.points, self.firmware_of(board))
        poses = tuple(resample(one, signal.cube.grid.frame_time_s) for one in motions)
        adc = signal.adc if request.keep_adc else None
        if adc is not None and self.calibration is not None and not request.config.is_coded:
            adc = self.calibration.recorded(adc)
        if not pose.is_at_camera:
            signal = replace(signal, assumptions=(*signal.assumptions, *unseen_notes(poses, request.range_window_m)))
        meta = self._meta(request, room, people, poses, signal, board)
        if request.radar_poses:
            meta["radar_pose"] = pose
        return Generation(
            cube=signal.cube,
            points=points,
            adc=adc,
            poses=poses,
            motions=motions,
            scene=room.scene,
            meta=meta,
            stages=stages,
            board=board,
        )

    def board_of(self, request: ParsedRequest, room: Room) -> tuple[Board, dict[str, Any]]:
        """The board of a signal, and the method's argument for it: none for an ideal one.

        What the radar's own .cfg compensates is no error of the signal. Raises InputError for a method that knows no
        boards, where one was asked for.
        """
        is_of_background = request.board is None and room.background is not None
        board = (
            self._background_board.of(room.background, room.background_board)
            if is_of_background
            else request.board_without_background
        )
        if request.board is None and self.calibration is not None:
            board = compensated(board)
        if board.is_ideal:
            return board, {}
        if takes_argument(self.method, "board"):
            return board, {"board": board}
        if request.board is not None:
            raise InputError(f"method {self.method_name!r} makes signals of an ideal board alone (docs/extend.md)")
        return IDEAL_BOARD, {}

    def firmware_of(self, board: Board) -> FirmwareSettings | None:
        """The settings of TI's point cloud, with the threshold of the board that was calibrated."""
        return None if self.firmware is None else self.firmware.with_threshold(board.cfar_threshold)

    def _meta(
        self,
        request: ParsedRequest,
        room: Room,
        people: tuple[Motion, ...],
        poses: tuple[PoseSequence, ...],
        signal: Signal,
        board: Board,
    ) -> dict[str, Any]:
        """What meta.json says of a sequence: all that is needed to make it again."""
        return {
            "schema_version": META_VERSION,
            "made_by": "mmweaver generate",
            "version": __version__,
            "text": request.text or people[0].plan.text,
            **request.meta(),
            "method": signal.method or self.method_name,
            "weights": self.weights,
            "board": board.meta(),
            "points": self.points,
            "firmware": self.firmware_of(board) if self.points == "firmware" else None,
            "inputs": room.inputs | _motion_input(request.motion),
            "camera": room.scene.photo.intrinsics,
            "assumed": _assumed(room.scene, people, (*signal.assumptions, *request.config.notes)),
            **_people_meta(poses, people),
        }


def compose_request(request: ParsedRequest, scene: Scene) -> tuple[Motion, ...]:
    """The motion of each person, the first one's from the recording where there is one.

    Raises InputError where the room has no place for it.
    """
    recorded = None
    if not request.people:
        return ()
    first = request.people[0]
    if request.motion is not None:
        clip = request.motion if first.height_m is None else request.motion.scaled_to(first.height_m)
        recorded = place_clip(
            clip,
            scene,
            duration_s=request.duration_s,
            seed=request.seed,
            range_window_m=request.range_window_m,
            start_m=first.start_m,
            heading_rad=request.heading_rad,
            as_recorded=request.as_recorded,
        )
        who = subject_of(request.seed) if first.subject is None else first.subject
        recorded = replace(recorded, pose=replace(recorded.pose, subject=who))
    return compose_people(
        [person.plan for person in request.people],
        scene,
        seed=request.seed,
        range_window_m=request.range_window_m,
        starts_m=[person.start_m for person in request.people],
        heights_m=[person.height_m for person in request.people],
        subjects=[person.subject for person in request.people],
        first=recorded,
        heading_rad=request.heading_rad,
        farthest_m=request.config.farthest_bin_m,
    )


def _found(weights: str | Path, revision: str | None = None) -> Path:
    from mmweaver.models.hub import find_weights

    return find_weights(weights, revision=revision)


def _assumed(scene: Scene, people: tuple[Motion, ...], of_method: tuple[str, ...]) -> list[str]:
    of_motion = (
        sentence if len(people) == 1 else f"person {number}: {sentence}"
        for number, person in enumerate(people, 1)
        for sentence in person.assumptions
    )
    return list(dict.fromkeys((*scene.assumptions, *of_motion, *of_method)))


def _people_meta(poses: tuple[PoseSequence, ...], people: tuple[Motion, ...]) -> dict[str, Any]:
    """`person`, `plan` and `clauses` of one; `people`, a list of all three, of several or of nobody."""
    described = [
        (_person(pose, person), {"plan": person.plan, "clauses": person.clauses})
        for pose, person in zip(poses, people, strict=True)
    ]
    if len(described) == 1:
        ((who, acts),) = described
        return {"person": who, **acts}
    return {"people": [{**who, **acts} for who, acts in described]}


def _motion_input(motion: MotionClip | None) -> dict[str, Any]:
    """What meta.json says of a recorded motion."""
    if motion is None:
        return {}
    digest = {} if motion.file is None else file_digest(motion.file)
    return {"motion": {**digest, "name": motion.label, "fps": motion.fps, "first_frame": motion.first_frame}}


def _person(pose: PoseSequence, motion: Motion) -> dict[str, Any]:
    who = motion.person
    drawn = {} if who is None else {"sex": who.sex, "age": who.age, "pace": round(who.pace, 3), "hand": who.hand}
    path_m = np.round(pose.joints_m[:, joint("pelvis"), :2], 3)
    return {
        "height_m": pose.height_m,
        "subject": pose.subject,
        "girth": pose.girth,
        **drawn,
        "starts_at_m": path_m[0],
        "ends_at_m": path_m[-1],
        "path_length_m": round(float(np.linalg.norm(np.diff(path_m, axis=0), axis=1).sum()), 3),
        "shown": motion.shown,
    }
