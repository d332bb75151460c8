"""Operations of the studio for a session: rooms, sequences, comparisons and exports. Blocking.

The server queues them.
"""

import ctypes
import gc
import sys
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from threading import Lock
from typing import Any, Generic, TypeVar

from mmweaver.core.board import Board
from mmweaver.core.boards import PRESETS, find_board
from mmweaver.core.errors import InputError, NoRoomError, error_code
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import chosen_range
from mmweaver.core.records import LANDMARK_KINDS
from mmweaver.evaluation.compare_signals import compare_signals
from mmweaver.evaluation.signal_evidence import ComparedSignal
from mmweaver.models.methods import METHODS
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.register_activity import load_activity_plugins
from mmweaver.recognition.recogniser import Recogniser, load_recogniser
from mmweaver.scene.photo_files import RoomFiles
from mmweaver.studio.live import Live
from mmweaver.studio.recordings import check_offered, read_offered
from mmweaver.studio.schemas import Form
from mmweaver.studio.sessions import BroughtRoom, Result, Session, Sessions
from mmweaver.viz.body_in_photo import pack
from mmweaver.viz.sequence import MAX_FRAMES, room_playback
from mmweaver.viz.theme import evenly_spaced
from mmweaver.weaver.front_door import Weaver
from mmweaver.weaver.generation import Generation, Room

DEMO = "demo"
FIRST_TEXT = "a person walks towards the radar, then waves with the left hand"
BOARDS = ("typical:0", "typical:1", "typical:2", "ideal")
_MAX_WEAVERS = 8  # each keeps its last room

T = TypeVar("T")


class Offered(Generic[T]):
    """Items available to every session, by the names of their folders; each is read on demand."""

    def __init__(self, what: str, places: list[Path], read: Callable[[Path], T], taken: tuple[str, ...] = ()):
        self._what, self._read, self._places = what, read, dict[str, Path]()
        for place in places:
            name = place.resolve().name
            while name in self._places or name in taken:
                name += "-2"
            self._places[name] = place

    @property
    def names(self) -> list[str]:
        """All names, in the order of the command line."""
        return list(self._places)

    def get(self, name: str) -> T:
        """Reads one item.

        Args:
            name: Its name.

        Raises:
            InputError: If it does not exist or cannot be read.
        """
        if name not in self._places:
            raise InputError(f"this {self._what} is not known here; choose another one")
        return self._read(self._places[name])


class RecoverableError(InputError):
    """A request that cannot be met.

    `recovery_options` are buttons of the page: a label, and the change of the request.
    """

    def __init__(self, message: str, recovery_options: list[dict[str, Any]], code: str = InputError.code):
        super().__init__(message)
        self.recovery_options, self.code = recovery_options, code


@contextmanager
def recovery_options(asked: Form) -> Iterator[None]:
    """Converts errors of motions that find no room, or do not fit their path, to changes that the page offers."""
    try:
        yield
    except NoRoomError as error:
        ways: list[dict[str, Any]] = []
        if error.recovery_options.get("range_m"):
            near_m, far_m = error.recovery_options["range_m"]
            label = f"range window {near_m:g} to {far_m:g} m"
            ways.append({"label": label, "change": {"range": [near_m, far_m]}})
        radars = error.recovery_options.get("radars", ())
        ways += [{"label": f"with {radar}", "change": {"radar": radar, "range": None}} for radar in radars]
        if asked.at:
            ways.append({"label": "start anywhere free", "change": {"at": None}})
        if asked.room != DEMO:
            ways.append({"label": "in the bundled room", "change": {"room": DEMO}})
        raise RecoverableError(str(error), ways, error.code) from None
    except InputError as error:
        if asked.path_m is not None:
            way = {"label": "without the path", "change": {"path": None}}
            raise RecoverableError(str(error), [way], "path") from None
        kind = next((kind for kind in LANDMARK_KINDS if f"no {kind} was found" in str(error)), None)
        if kind is None:
            raise
        way = {"label": f"show where the {kind} is", "change": {"landmark": kind}}
        raise RecoverableError(str(error), [way], "no_target") from None


class Service:
    """Rooms and weights shared by all sessions."""

    def __init__(
        self,
        rooms: list[Path] | None = None,
        recordings: list[Path] | None = None,
        recognisers: list[Path] | None = None,
    ):
        files = Offered("room", rooms or [], RoomFiles.find, (DEMO,))
        self._rooms = {name: _offered_room(files.get(name)) for name in files.names}
        self._rooms[DEMO] = BroughtRoom(label="bundled sample", options=("--demo",), call="sample_room()", read=_sample)
        for path in recordings or ():
            check_offered(path)
        self.recordings = Offered("recording", recordings or [], read_offered)
        self.recognisers: Offered[Recogniser] = Offered("recogniser", recognisers or [], load_recogniser)
        for name in self.recognisers.names:
            self.recognisers.get(name)  # one that is damaged is refused at once
        self.sessions = Sessions()
        self._weavers: OrderedDict[tuple[Any, ...], Weaver] = OrderedDict()
        self._marked: OrderedDict[tuple[Any, ...], Room] = OrderedDict()  # rooms with landmarks that a visitor placed
        self._lock = Lock()

    def warm_up(self) -> None:
        """Reads the first room and generates one sequence in it, so that the first visitor does not wait."""
        name = next(iter(self._rooms))
        asked = Form(room=name, text=[FIRST_TEXT])
        weaver = self._weaver(asked, PRESETS[asked.radar])
        weaver.generate(self._rooms[name].room, FIRST_TEXT, board=asked.board_name)

    def offer(self) -> dict[str, Any]:
        """Choices of the page's controls."""
        load_activity_plugins()
        return {
            "rooms": [(name, room.label) for name, room in self._rooms.items()],
            "radars": [(name, name) for name in PRESETS],
            "methods": [("auto", "network"), ("physics", "physics (ray-traced)")],
            "boards": [(name, name.replace(":", " ")) for name in BOARDS],
            "recognisers": self.recognisers.names,
            "recordings": self.recordings.names,
            "sentences": [activity.example for activity in BY_KEY.values()],
            "text": FIRST_TEXT,
        }

    def room_of(self, session: Session, name: str) -> BroughtRoom:
        """A room by its id, one of the session's or an offered one. InputError if it is not known."""
        known = self._rooms | session.rooms
        if name not in known:
            raise InputError("this room is not known here; choose another one")
        return known[name]

    def _room(self, session: Session, asked: Form) -> Room:
        """The room of a request, with the landmarks that came with it; the same object for the same landmarks."""
        with error_code("room"):
            room = self.room_of(session, asked.room).room
        if not asked.landmark:
            return room
        key = (session.id, asked.room, *asked.landmark)
        with self._lock:
            if key not in self._marked:
                self._marked[key] = room.with_landmarks(*asked.landmark)
                while len(self._marked) > _MAX_WEAVERS:
                    self._marked.popitem(last=False)
            return self._marked[key]

    @staticmethod
    def radar_of(session: Session, name: str) -> RadarConfig:
        """A radar by its id, one of the session's, or the name of a preset. InputError if it is not known."""
        if name in session.radars:
            return session.radars[name][1]
        if name not in PRESETS:
            raise InputError(f"unknown radar {name!r}; choose one of the list")
        return PRESETS[name]

    @staticmethod
    def board_of(session: Session, name: str, radar: RadarConfig) -> Board:
        """A board by its id, one of the session's, or "ideal" or "typical:N" for a radar. InputError if unknown."""
        if name in session.boards:
            return find_board(session.boards[name][1], radar)
        if name != "ideal" and not name.startswith("typical:"):
            raise InputError(f"unknown board {name!r}; choose one of the list")
        return find_board(name, radar)

    @staticmethod
    def motion_of(session: Session, name: str | None) -> MotionClip | None:
        """A motion uploaded to the session; None gives None. InputError if it is not known."""
        if name is not None and name not in session.motions:
            raise InputError("this motion is no longer kept; open its file again")
        return None if name is None else session.motions[name][1]

    def _radar(self, session: Session, asked: Form) -> RadarConfig:
        """The radar of a request, with its range window."""
        with error_code("range"):
            return chosen_range(self.radar_of(session, asked.radar), asked.range_m)

    def room_bytes(self, session: Session, name: str, radar: str, window: str = "") -> bytes:
        """A room, packed for the page, with the places where this radar can observe a person.

        Args:
            session: The session.
            name: Id of the room.
            radar: Id of the radar.
            window: Range window, "near,far" in metres; "" for the radar's own.
        """
        label = session.rooms[name].label if name in session.rooms else name
        asked = Form.of({"room": name, "radar": radar, "range": window, "text": [FIRST_TEXT]})
        range_m = self._radar(session, asked).range_m
        shown = room_playback(self._room(session, asked).scene, label, (float(range_m[0]), float(range_m[-1])))
        return pack(shown.header, shown.arrays)

    def generate(self, session: Session, body: Any) -> bytes:
        """Generates a sequence, kept in the session and packed for the page.

        Args:
            session: The session.
            body: JSON of the form.

        Raises:
            InputError: If the request cannot be met.
        """
        asked = Form.of(body)
        room, radar = self.room_of(session, asked.room), self._radar(session, asked)
        board = self.board_of(session, asked.board_name, radar)
        request = replace(asked.request, motion=self.motion_of(session, asked.motion_id), board=board)

        def made(keep_adc: bool = False) -> Generation:
            weaver = self._weaver(asked, radar)  # a kept result must not keep a prepared room
            with error_code("sentence"):
                parsed = weaver.parsed(replace(request, keep_adc=keep_adc))
            return weaver.carry_out(parsed, self._room(session, asked))

        with recovery_options(asked):
            generation = made()
        names = {
            "radar": session.radars.get(asked.radar, (asked.radar,))[0],
            "board": session.boards.get(asked.board_name, (asked.board_name,))[0],
            "motion": None if asked.motion_id is None else session.motions[asked.motion_id][0],
        }
        repeated = {"command": asked.command([*room.options], **names), "python": asked.python(room.call, **names)}
        result = Result(
            cube=generation.cube,
            points=generation.points,
            poses=generation.poses,
            meta=generation.meta,
            generation=generation,
            with_samples=lambda: made(keep_adc=True),
            rays=lambda frame: self._weaver(asked, radar).rays(self._room(session, asked), generation, frame),
        )
        return self._kept(session, result, {"seconds": generation.stages.seconds, **repeated})

    def recording(self, session: Session, name: str) -> bytes:
        """An offered recording, kept in the session and packed for the page.

        Args:
            session: The session.
            name: Name of the recording.

        Raises:
            InputError: If it is unknown or cannot be read.
        """
        with error_code("recording"):
            return self._kept(session, self.recordings.get(name), {})

    @staticmethod
    def compare(session: Session, a: str, b: str) -> dict[str, Any]:
        """The comparison of two kept results, see `comparison`.

        Args:
            session: The session.
            a: Id of the reference.
            b: Id of the result that is compared with it.

        Raises:
            InputError: If one is no longer kept, or they cannot be compared.
        """
        return comparison(session.result(a), session.result(b))

    def result_bytes(self, session: Session, name: str) -> bytes:
        """A kept result, packed for the page."""
        return self._packed(session.result(name), name, {})

    @staticmethod
    def rays(session: Session, name: str, frame: str) -> bytes:
        """Propagation paths of frame `frame` of a kept result, packed for the page.

        Raises:
            InputError: If it is no longer kept, was not generated here, or has no such frame.
        """
        result = session.result(name)
        shown = [] if result.cube is None else evenly_spaced(len(result.cube.values), MAX_FRAMES)
        if result.rays is None or not frame.isdecimal() or not int(frame[:6]) < len(shown):
            raise InputError("there are propagation paths of generated sequences alone, and for each of their frames")
        return pack({"kind": "rays"}, result.rays(int(shown[int(frame)])).arrays)

    def live(self, session: Session, body: Any) -> Live:
        """Starts a stream in one of the session's rooms.

        Args:
            session: The session.
            body: JSON of the form.

        Raises:
            InputError: If the request cannot be met.
        """
        asked = Form.of(body)
        radar = self._radar(session, asked)
        board = self.board_of(session, asked.board_name, radar)
        room = self._room(session, asked)
        if asked.recogniser is None:
            return Live(self._weaver(asked, radar), room, asked, board)
        recogniser = self.recognisers.get(asked.recogniser)  # learned from the points of a board's firmware
        return Live(Weaver(method=asked.method, radar=radar, points="firmware"), room, asked, board, recogniser)

    def end(self, session: Session) -> None:
        """Ends a session and frees everything prepared for its rooms, radars and boards."""
        own = {*session.rooms, *session.radars, *session.boards}
        with self._lock:
            for key in [key for key in self._weavers if own & set(key)]:
                del self._weavers[key]
        self.sessions.end(session)
        trim_memory()

    def _kept(self, session: Session, result: Result, more: dict[str, Any]) -> bytes:
        name = session.add(result)
        self.sessions.keep_within_memory()
        trim_memory(collect=False)
        return self._packed(result, name, more)

    @staticmethod
    def _packed(result: Result, name: str, more: dict[str, Any]) -> bytes:
        shown = result.playback()
        return pack({**shown.header, **more, "result": name}, shown.arrays)

    def _weaver(self, asked: Form, radar: RadarConfig) -> Weaver:
        """A generator for this room, radar, board and method, cached with the prepared room."""
        if asked.method not in METHODS:
            raise InputError(f"unknown method {asked.method!r}; choose one of the list")
        key = (asked.room, asked.radar, asked.board_name, asked.method, asked.range_m)
        with self._lock:
            if key not in self._weavers:
                self._weavers[key] = Weaver(method=asked.method, radar=radar)
                while len(self._weavers) > _MAX_WEAVERS:
                    self._weavers.popitem(last=False)
            self._weavers.move_to_end(key)
            return self._weavers[key]


def trim_memory(*, collect: bool = True) -> None:
    """Gives freed memory back to the system; glibc would keep it for every thread."""
    if sys.platform.startswith("linux"):
        if collect:
            gc.collect()
        getattr(ctypes.CDLL(None), "malloc_trim", lambda _: 0)(0)


def _sample() -> Room:
    return Weaver(method="physics").sample_room()


def _offered_room(files: RoomFiles) -> BroughtRoom:
    def read() -> Room:
        return Weaver(method="physics").read_room(files.rgb, files.depth, files.camera)

    return BroughtRoom(label=files.rgb.parent.resolve().name, options=tuple(files.options), call=files.call, read=read)


def comparison(a: Result, b: Result) -> dict[str, Any]:
    """The results of `mmweaver compare`: text and values, and a row for each feature that both sides have.

    Args:
        a: The reference.
        b: The result that is compared with it.

    Raises:
        InputError: If one of them is a point cloud alone, or they have no common ranges.
    """

    def signal(result: Result, name: str) -> ComparedSignal:
        if result.cube is None:
            raise InputError(f"{name} is a point cloud alone; numbers need a signal on both sides")
        adc = None if result.generation is None else result.generation.adc
        return ComparedSignal(name=result.title, cube=result.cube, adc=adc, points=result.points, meta=result.meta)

    found = compare_signals([signal(a, "A")], [signal(b, "B")], names=(f"A: {a.title}", f"B: {b.title}"))
    rows = [
        {
            "title": one.feature.title,
            "effect": one.difference.effect_size,
            "a": one.a.text(one.feature.unit),
            "b": one.b.text(one.feature.unit),
            "gives_away": one.gives_away,
        }
        for one in found.ranked
        if one.difference is not None
    ]
    return {"text": found.text(), "values": found.to_values(), "rows": rows}
