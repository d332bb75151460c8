"""Sessions of the studio: each has its own rooms, results and folder, which are removed when it ends.

There are MAX_SESSIONS at most. One more ends another: of the client that has the most, one that was never used, else
the one unused for longest; those whose request is being answered stay. What a session keeps is bounded, too.
"""

import contextlib
import secrets
import shutil
import tempfile
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from threading import Lock
from time import monotonic
from typing import Any

from mmweaver.core.board import Board
from mmweaver.core.errors import InputError, error_code
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.records import PointCloud, PoseSequence, RadarCube
from mmweaver.core.staging import staging_path, sweep
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.propagation.rays import Rays
from mmweaver.viz.points_playback import point_log_playback
from mmweaver.viz.sequence import Playback, make_playback
from mmweaver.weaver.generation import Generation, Room

MAX_SESSIONS = 1000
MAX_RESULTS = 6  # per session; the oldest are dropped first
MAX_RESULT_BYTES = 1_000_000_000  # cubes and samples of all sessions
ROOM_BYTES = 20_000_000  # about what a room that was brought takes
MAX_BROUGHT = 8  # rooms, radars, boards, motions and photos of a session, of each kind; the oldest are dropped first
MAX_UPLOAD_BYTES = 1_000_000_000  # of all uploads that are being received or read
MAX_SOCKETS = 4  # open WebSockets of a session
UNUSED_S = 1800.0  # idle time after which a session that was not closed ends


FOLDER = "mmweaver-studio"


def remove_abandoned() -> None:
    """Removes the folders of sessions whose server was killed."""
    sweep(Path(tempfile.gettempdir()), again=True)


def _file_of(value: Any) -> Path | None:
    """The file that something brought is still read from: that of a photo, or of a named motion."""
    return value if isinstance(value, Path) else getattr(value[-1], "file", None) if isinstance(value, tuple) else None


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

    def __init__(self, client: str = "") -> None:
        self.id = secrets.token_urlsafe(16)
        self.client = client
        self.folder = staging_path(Path(tempfile.gettempdir()) / FOLDER)  # what a killed server leaves is recognized
        self.folder.mkdir(mode=0o700)
        self.rooms: dict[str, BroughtRoom] = {}  # by id
        self.radars: dict[str, tuple[str, RadarConfig]] = {}  # by id: file name and radar
        self.boards: dict[str, tuple[str, Board]] = {}  # by id: file name and board
        self.motions: dict[str, tuple[str, MotionClip]] = {}  # by id: file name and motion
        self.results: OrderedDict[str, Result] = OrderedDict()
        self.pinned: str | None = None  # the result that the next ones are compared with
        self.photos: dict[str, Path] = {}  # by id: pictures that came without depth
        self.used_s = monotonic()
        self.is_used = False  # whether it has asked for anything
        self.running = 0  # requests that are being answered
        self.sockets = 0
        self.is_open = True

    @contextlib.contextmanager
    def answering(self) -> Iterator[None]:
        """A request of the session is being answered."""
        self.running += 1
        try:
            yield
        finally:
            self.running -= 1
            self.used_s, self.is_used = monotonic(), True

    def bring(self, kept: dict[str, Any], name: str, value: Any) -> None:
        """Keeps something that was uploaded; the oldest of its kind are dropped beyond MAX_BROUGHT."""
        kept[name] = value
        while len(kept) > MAX_BROUGHT:
            oldest = _file_of(kept.pop(next(iter(kept))))
            if oldest is not None:
                oldest.unlink(missing_ok=True)

    def needs(self, folder: Path) -> bool:
        """Whether a photo that waits for its depth, or a motion, is still read from a folder."""
        files = map(_file_of, (*self.photos.values(), *self.motions.values()))
        return any(folder in file.parents for file in files if file is not None)

    def add(self, result: Result) -> str:
        """Keeps a result and returns its id; the oldest are dropped beyond MAX_RESULTS."""
        name = secrets.token_urlsafe(9)
        self.results[name] = result
        while len(self.results) > MAX_RESULTS:
            self.forget_oldest()
        return name

    @property
    def num_bytes(self) -> int:
        """Memory of results and rooms in bytes."""
        return sum(one.num_bytes for one in self.results.values()) + ROOM_BYTES * len(self.rooms)

    def forget_oldest(self) -> None:
        """Drops the oldest result; the pinned one is the last to go, before rooms."""
        if not self.results:
            self.rooms.pop(next(iter(self.rooms)))
            return
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
        self._uploading = 0  # bytes

    @contextlib.contextmanager
    def uploading(self, num_bytes: int) -> Iterator[None]:
        """Reserves room for an upload.

        Raises:
            InputError: If too much is being uploaded.
        """
        with self._lock:
            if self._uploading + num_bytes > MAX_UPLOAD_BYTES:
                raise InputError("others are uploading at the moment; try again in a minute")
            self._uploading += num_bytes
        try:
            yield
        finally:
            with self._lock:
                self._uploading -= num_bytes

    def open(self, client: str = "") -> Session:
        """Opens a session, after ending idle ones and, if there are too many, another one.

        Args:
            client: Address of the client.

        Raises:
            InputError: If there are too many, and all are being answered.
        """
        with self._lock:
            for session in [one for one in self._open.values() if monotonic() - one.used_s > UNUSED_S]:
                if not session.running:
                    self._end(session)
            if len(self._open) >= MAX_SESSIONS:
                self._end(self._least_used())
            session = Session(client)
            self._open[session.id] = session
            return session

    def _least_used(self) -> Session:
        """The session that makes room for another."""
        idle = [one for one in self._open.values() if not one.running]
        if not idle:
            raise InputError(f"the studio is answering {MAX_SESSIONS} sessions; try again in a minute")
        counts = Counter(one.client for one in idle)
        most = max(counts.values())
        return min((one for one in idle if counts[one.client] == most), key=lambda one: (one.is_used, one.used_s))

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
                sizes = {one: one.num_bytes for one in self._open.values()}
                if sum(sizes.values()) <= MAX_RESULT_BYTES or not sizes:
                    return
                largest = max(sizes, key=lambda one: sizes[one])
                largest.forget_oldest()

    def _end(self, session: Session) -> None:
        self._open.pop(session.id, None)
        session.end()
