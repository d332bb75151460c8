"""Sessions of the studio: each has its own rooms, results and folder, which are removed when it ends."""

import secrets
import shutil
import tempfile
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from threading import Lock
from time import monotonic

from mmweaver.core.board import Board
from mmweaver.core.errors import InputError, error_code
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud, PoseSequence, RadarCube
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.propagation.rays import Rays
from mmweaver.viz.points_playback import point_log_playback
from mmweaver.viz.sequence import Playback, make_playback
from mmweaver.weaver.generation import Generation, Room

MAX_SESSIONS = 100
MAX_RESULTS = 6  # per session; the oldest are dropped first
MAX_RESULT_BYTES = 1_000_000_000  # cubes and samples of all sessions
UNUSED_S = 1800.0  # idle time after which a session that was not closed ends


@dataclass(frozen=True, kw_only=True)
class Result:
    """A sequence that a session generated or uploaded, with everything that reproduces a generated one."""

    cube: RadarCube | None  # None for a log of points, which has `frame_period_s` and the name of its `radar`
    points: PointCloud
    poses: tuple[PoseSequence, ...]
    meta: dict
    frame_period_s: float = 0.1
    radar: str = ""
    generation: Generation | None = None
    rays: Callable[[int], Rays] | None = None  # propagation paths of a frame
    with_samples: Callable[[], Generation] | None = None  # generates the same sequence with its ADC samples

    @property
    def num_bytes(self) -> int:
        """Memory of cube, points and samples in bytes."""
        adc = None if self.generation is None else self.generation.adc
        cube_bytes = 0 if self.cube is None else self.cube.values.nbytes
        return cube_bytes + 48 * len(self.points.frame) + (0 if adc is None else adc.samples.nbytes)

    @property
    def title(self) -> str:
        """The sentences, or the recording's name, and the radar."""
        text = self.meta.get("text") or ""
        radar = self.radar if self.cube is None else self.cube.config.name
        return f"{text if isinstance(text, str) else ' | '.join(text)}   ({radar})"

    def playback(self) -> Playback:
        """The sequence for the playback page."""
        if self.cube is None:
            return point_log_playback(self.points, self.frame_period_s, self.radar, self.meta)
        return make_playback(self.cube, self.points, self.poses, self.meta)


@dataclass(kw_only=True, eq=False)
class BroughtRoom:
    """A room, its options of `mmweaver generate`, and the call of `Weaver` that reads it."""

    label: str
    options: tuple[str, ...]
    call: str
    read: Callable[[], Room]

    @cached_property
    def room(self) -> Room:
        """The room, read on first use; InputError if it cannot be read."""
        return self.read()


class Session:
    """One tab of a browser."""

    def __init__(self) -> None:
        self.id = secrets.token_urlsafe(16)
        self.folder = Path(tempfile.mkdtemp(prefix="mmweaver-studio-"))  # readable by this user alone
        self.rooms: dict[str, BroughtRoom] = {}  # by id
        self.radars: dict[str, tuple[str, RadarConfig]] = {}  # by id: file name and radar
        self.boards: dict[str, tuple[str, Board]] = {}  # by id: file name and board
        self.motions: dict[str, tuple[str, MotionClip]] = {}  # by id: file name and motion
        self.results: OrderedDict[str, Result] = OrderedDict()
        self.pinned: str | None = None  # the result that the next ones are compared with
        self.photos: dict[str, Path] = {}  # by id: pictures that came without depth
        self.used_s = monotonic()
        self.is_open = True

    def add(self, result: Result) -> str:
        """Keeps a result and returns its id; the oldest are dropped beyond MAX_RESULTS."""
        name = secrets.token_urlsafe(9)
        self.results[name] = result
        while len(self.results) > MAX_RESULTS:
            self.forget_oldest()
        return name

    def forget_oldest(self) -> None:
        """Drops the oldest result; the pinned one is the last to go."""
        self.results.pop(next((name for name in self.results if name != self.pinned), next(iter(self.results))))

    def result(self, name: str) -> Result:
        """A result by its id.

        Args:
            name: The id.

        Raises:
            InputError: If it is not of this session, or no longer kept.
        """
        if name not in self.results:
            with error_code("gone"):
                raise InputError("this result is no longer kept; generate it again")
        return self.results[name]

    def keep(self, name: str) -> dict[str, str]:
        """Pins the result that others are compared with; "none" releases it."""
        self.pinned = None if name == "none" or not self.result(name) else name
        return {}

    def end(self) -> None:
        """Removes the session's folder, rooms and results."""
        self.is_open = False
        for brought in (self.rooms, self.radars, self.boards, self.motions, self.photos):
            brought.clear()
        self.results.clear()
        shutil.rmtree(self.folder, ignore_errors=True)


class Sessions:
    """All open sessions, bounded in number and memory."""

    def __init__(self) -> None:
        self._open: dict[str, Session] = {}
        self._lock = Lock()

    def open(self) -> Session:
        """Opens a session, after closing idle ones.

        Raises:
            InputError: If there are too many.
        """
        with self._lock:
            for session in [one for one in self._open.values() if monotonic() - one.used_s > UNUSED_S]:
                self._end(session)
            if len(self._open) >= MAX_SESSIONS:
                raise InputError(f"the studio has {MAX_SESSIONS} open sessions; close a tab and load the page again")
            session = Session()
            self._open[session.id] = session
            return session

    def get(self, name: str) -> Session:
        """A session by its id.

        Args:
            name: The id.

        Raises:
            InputError: If it does not exist.
        """
        session = self._open.get(name)
        if session is None:
            with error_code("session"):
                raise InputError("this session has ended; load the page again")
        session.used_s = monotonic()
        return session

    def end(self, session: Session) -> None:
        """Ends a session."""
        with self._lock:
            self._end(session)

    def end_all(self) -> None:
        """Ends all sessions, when the server stops."""
        with self._lock:
            for session in list(self._open.values()):
                self._end(session)

    def keep_within_memory(self) -> None:
        """Drops the oldest results of the largest sessions until all fit."""
        with self._lock:
            while True:
                sizes = {one: sum(r.num_bytes for r in one.results.values()) for one in self._open.values()}
                if sum(sizes.values()) <= MAX_RESULT_BYTES or not sizes:
                    return
                largest = max(sizes, key=lambda one: sizes[one])
                largest.forget_oldest()

    def _end(self, session: Session) -> None:
        self._open.pop(session.id, None)
        session.end()
