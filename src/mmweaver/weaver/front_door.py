"""The front door: photo and sentence in, radar signal out. Read this file first.

    photo + depth --scene--> Scene --------------------+
                               |                       +--method--> RadarCube --signal--> PointCloud
    sentences -----motion--> PoseSequences, placed ----+

Only this file knows the order of the packages; they exchange the records of `core/records.py` and nothing else.
"""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from mmweaver.core.board import Board, ChannelCalibration
from mmweaver.core.boards import IDEAL_BOARD, PRESETS, compensated
from mmweaver.core.constants import __version__
from mmweaver.core.errors import InputError
from mmweaver.core.firmware_settings import FirmwareSettings
from mmweaver.core.options import keywords_of
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.radar_pose import AT_CAMERA
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import single_precision
from mmweaver.core.skeleton import joint
from mmweaver.core.stages import Stages
from mmweaver.evaluation.background_board import BackgroundBoard
from mmweaver.io.radar_file import load_firmware, load_radar
from mmweaver.io.result_folder import META_VERSION, file_digest
from mmweaver.io.ti_calibration import read_ti_calibration
from mmweaver.models.methods import DEFAULT_METHOD, METHODS, Learned, Method, Signal
from mmweaver.motion.animation.root_path import resample
from mmweaver.motion.compose import Motion
from mmweaver.motion.continuous import ContinuousMotion
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.mocap.read_motion import read_motion
from mmweaver.motion.physiology import living
from mmweaver.motion.planning.placement import Conditions
from mmweaver.propagation.rays import Rays
from mmweaver.propagation.static_paths import ALL_PATHS
from mmweaver.propagation.things import ThingPaths
from mmweaver.scene.moved_radar import people_seen_from, scene_seen_from, unseen_notes
from mmweaver.signal.detection import check_points, detect, needs_adc, substitutes
from mmweaver.weaver.composition import compose_request, furnished_room, widened, with_targets
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
    """Generates radar signals with one method and one radar."""

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
        """Chooses method, radar and point detector.

        Args:
            method: Name in METHODS, "weaver" (the network; also called "auto", the default) or "physics", or an object
                that follows `methods.Method`.
            radar: Name of a preset, a TI .cfg or radar.json file, or a RadarConfig.
            listener: Called with the name of each stage as it begins.
            points: Point detector: "cfar", the project's own, "firmware", that of TI's demo, which needs ADC samples,
                or a registered one.
            firmware: Settings of TI's detector; by default those of the radar's .cfg or preset.
            weights: File or folder of `mmweaver train`, or a name on the Hub, for the network, which then makes all
                signals; `from_pretrained` is the short form.
            calibration: Channel errors that the radar's firmware compensates; by default those of its .cfg. ADC samples
                are then as that board records them, cube and points as it compensates them.

        Raises:
            InputError: For unknown names, and for weights without the network.
        """
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
        self.widens = False  # whether a sentence that lacks floor gets a wider range window
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

        Args:
            source: Weight file, folder of `mmweaver train`, or name on the Hub.
            radar: As for the class; by default the radar that the network was trained for.
            revision: Branch, tag or commit on the Hub.
            **options: Further arguments of the class.

        Raises:
            InputError: For files that are damaged, foreign or of another version.
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
        """Reads a recorded motion for `generate`: BVH, AMASS/SMPL, HumanML3D, CMU or joints; see docs/motion_files.md.

        Args:
            path: A .bvh, .npy or .npz file.
            fps: Frames per second; required where the file does not state them, and overrides what it states.
            unit: m, cm, mm, inch, cmu, or the length of one unit in metres; by default estimated from the body.
            up: Upward axis, y, z, ...; by default estimated from the body.
            clip: Name of one motion in a file of several.
            body_model: The user's own SMPL model (.npz); by default the mean skeleton.

        Returns:
            22 joints in metres, z up, with notes on what was estimated.

        Raises:
            InputError: If the file is not a human motion.
        """
        return read_motion(path, fps=fps, unit=unit, up=up, clip=clip, body_model=body_model)

    @keywords_of(Request, "text")
    def request(self, text: str | Sequence[str] | None = None, **asked: Any) -> ParsedRequest:
        """A checked and parsed request, with the arguments of `generate`. Fast, since no room is needed.

        Raises:
            InputError: For a request that cannot be met.
        """
        return self.parsed(Request(text=text, **asked))

    def parsed(self, request: Request) -> ParsedRequest:
        """A checked and parsed request from a record.

        Args:
            request: The request.

        Raises:
            InputError: For a request that cannot be met.
        """
        return parse(request, self.radar, needs_adc=needs_adc(self.points))

    @keywords_of(Request, "text")
    def generate(self, room: Room, text: str | Sequence[str] | None = None, **asked: Any) -> Generation:
        """Generates the signal of people doing what a text describes or a recorded motion shows, in a room.

        The sentence determines the duration (at least two seconds), and a recorded motion keeps its own; `frames` or
        `seconds` override it: a sentence is then stretched, repeated or cut, which `meta` reports. People keep a
        distance of half a metre. The same seed gives the same bits.

        Args:
            room: From `read_room`, `open_room` or `sample_room`; can be used any number of times.
            text: What the person does, or a list with one text per person; "nobody" alone gives the empty room.
            motion: Recorded motion of `read_motion` or a motion model for the first person, whose text names it.
            frames, seconds: Number of radar frames, or duration in seconds (default: as the sentence needs).
            fps: Frames per second (default: the radar's own, 10 for the awr1843).
            seed: Seed of everything that is sampled.
            at: Where the person starts, (x right, y away from the radar) in metres; sampled if not given.
            heading_rad: Initial direction of the first person's body, from +x towards +y.
            path_m: Corners (x, y) of the first person's walk in metres.
            height_m: Body height in metres; a recorded body is scaled to it.
            subject: Number of the person, 0 to 9999: skin, build, habits, typical height; by default sampled by the
                seed.
            as_recorded: Whether the positions of a motion are already in the radar's coordinates.
            keep_adc: Whether raw samples are returned, several times the cube's memory; the cube does not depend on it.
            board: Board whose errors the signal has: "typical" (sampled by the seed; the default, except with a
                background, whose board is used), "typical:N", "ideal", a board.json or a `Board` (docs/board.md).
            reflectors: Each a `Reflector` of known cross section (docs/things.md).
            interferers: Each an `Interferer`, another radar.
            things: Moving things other than people, each a `Thing`: fan, curtain, door, cat ... (docs/things.md).
            radar_poses: One `RadarPose` per radar that records the scene (default: one at the camera).

        For several people `at`, `height_m` and `subject` are lists.

        Returns:
            Cube, points, poses and metadata; ADC samples if requested.

        Raises:
            InputError: For a request that cannot be met.
        """
        return self.carry_out(self.request(text, **asked), room)

    def stream(
        self, room: Room, sentences: Iterable[str | None], *, chunk_frames: int = CHUNK_FRAMES, **asked: Any
    ) -> Iterator[StreamChunk]:
        """Generates the continuous signal of one person who acts out one sentence after the other.

        Each sentence begins at the person's current place and posture, and takes as long as it needs; its last chunk
        may have fewer than `chunk_frames` frames. A sentence that is not understood, or does not fit into the room, is
        skipped and reported in `StreamChunk.refused`; for the first one it is an InputError. The same seed and
        sentences give the same bits, whatever `chunk_frames` is, except for sentences of None, each of which lasts one
        chunk. Memory does not grow with the length of the stream.

        Args:
            room: As for `generate`.
            sentences: Any iterable, possibly live: the next sentence is requested when the last one is finished. None
                or "" continues the last activity, or holds the posture, for one more chunk.
            chunk_frames: Radar frames per chunk.
            asked: `seed`, `at`, `heading_rad`, `height_m`, `subject`, `fps`, `keep_adc` and `board` as for `generate`.

        Yields:
            Consecutive chunks of cube, points and poses.

        Raises:
            InputError: For a request that cannot be met.
        """
        check_streams(self.method, self.method_name)
        parser = asked.pop("parser", None)  # of the sentences to come
        request = replace(self.request("a person stands", frames=1, **asked), parser=parser)
        (person,) = request.people
        motion = ContinuousMotion(
            room.scene,
            Conditions(seed=request.seed, start_m=person.start_m, heading_rad=request.heading_rad),
            frame_period_s=request.config.frame_period_s,
            range_window_m=request.range_window_m,
            farthest_m=request.config.farthest_bin_m,
            height_m=person.height_m,
            subject=person.subject,
            missing=request.missing,
            strict=request.strict,
        )
        return Streamer(self, room, request, motion, chunk_frames).chunks(sentences)

    @single_precision()
    def carry_out(self, request: ParsedRequest, room: Room, people: tuple[Motion, ...] | None = None) -> Generation:
        """Generates the signal of a parsed request.

        Args:
            request: From `request` or `parsed`.
            room: As for `generate`.
            people: Motions in the camera's coordinates, if they have been composed already.

        Raises:
            InputError: If the room has no space for the motion.
        """
        poses = request.radar_poses or (AT_CAMERA,)
        if room.background is not None and len(poses) > 1:
            raise InputError("a background recording is of one radar; give one radar pose, that of the recording")
        stages = Stages(self._listener)
        stages.seconds.update(room.seconds)
        with stages("compose the motion"):
            if people is None:
                room = furnished_room(request, room)
                may_widen = self.widens and room.background is None and request.motion is None
                request, people = (
                    widened(request, room.scene) if may_widen else (request, compose_request(request, room.scene))
                )
        room = with_targets(room, request)
        scenes = [scene_seen_from(room.scene, pose) for pose in poses]
        results = [self._recorded(request, replace(room, scene=scene), people, stages) for scene in scenes]
        return replace(results[0], further=tuple(results[1:]))

    @single_precision()
    def rays(self, room: Room, generation: Generation, frame: int) -> Rays:
        """The propagation paths of one frame of a signal: their corners in the room, kind, level and cell.

        Args:
            room: The room that the signal was generated in.
            generation: A signal of this Weaver.
            frame: Number of the frame.

        Raises:
            InputError: If the method does not give its paths, or there is no such frame.
        """
        paths_of: Any = getattr(self.method, "paths", None)
        if paths_of is None:
            raise InputError(f"method {self.method_name!r} does not give its propagation paths")
        if not 0 <= frame < len(generation.cube.values):
            raise InputError(f"frame is 0 to {len(generation.cube.values) - 1}, not {frame}")
        scene = generation.scene
        paths = paths_of(
            scene,
            generation.motions,
            generation.cube.config,
            frame=frame,
            seed=generation.meta["seed"],
            background=room.background,
            board=None if generation.board.is_ideal else generation.board,
        )
        joints_m = np.concatenate([np.zeros((0, 3)), *(pose.joints_m[frame] for pose in generation.poses)])
        return Rays.of(paths, joints_m, scene.planes)

    def _recorded(self, request: ParsedRequest, room: Room, people: tuple[Motion, ...], stages: Stages) -> Generation:
        """The signal of one radar; `room` is in its coordinates, the people in the camera's."""
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
        time_s = signal.cube.grid.frame_time_s
        poses = tuple(
            living(resample(one, time_s), request.seed, pose, time_s[-1] + request.config.frame_period_s)
            for one in motions
        )
        adc = signal.adc if request.keep_adc else None
        if adc is not None and self.calibration is not None and not request.config.is_coded:
            adc = self.calibration.recorded(adc)
        if not pose.is_at_camera:
            signal = replace(signal, assumptions=(*signal.assumptions, *unseen_notes(poses, request.range_window_m)))
        meta = self._meta(request, room, people, poses, signal, board)
        if request.radar_poses:
            meta["radar_pose"] = pose
        things = ThingPaths(room.scene, request.config).truth(time_s)
        if things:
            meta["things"] = [{"kind": one.kind, "starts_at_m": one.place_m[0], **one.facts} for one in things]
        meta |= {name: one for name in ("reflectors", "interferers") if (one := getattr(room.scene, name))}
        return Generation(
            things=things,
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
        """The board of a signal, and the keyword argument that passes it to the method, empty for an ideal board.

        Errors that the radar's own .cfg compensates are not errors of the signal.

        Args:
            request: The parsed request.
            room: The room, for the board of its background recording.

        Raises:
            InputError: If a board was requested and the method does not support boards.
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
        """Settings of TI's detector, with the threshold of a calibrated board."""
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
        """The contents of meta.json: everything that is needed to reproduce the sequence."""
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
            "assumed": _assumed(
                room.scene,
                people,
                (*signal.assumptions, *request.config.notes, *substitutes(self.points, self.firmware)),
            ),
            **_people_meta(poses, people),
        }


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
    """`person`, `plan` and `clauses` of one person; `people`, a list of all three, of several or none."""
    described = [
        (_person(pose, person), {"plan": person.plan, "clauses": person.clauses})
        for pose, person in zip(poses, people, strict=True)
    ]
    if len(described) == 1:
        ((who, acts),) = described
        return {"person": who, **acts}
    return {"people": [{**who, **acts} for who, acts in described]}


def _motion_input(motion: MotionClip | None) -> dict[str, Any]:
    """Entry of a recorded motion in meta.json."""
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
        **({} if pose.vitals is None else {name: getattr(pose.vitals, name) for name in ("breathing_hz", "heart_hz")}),
        "starts_at_m": path_m[0],
        "ends_at_m": path_m[-1],
        "path_length_m": round(float(np.linalg.norm(np.diff(path_m, axis=0), axis=1).sum()), 3),
        "shown": motion.shown,
    }
