"""What the studio does for a session: rooms, sequences, comparisons and exports. Blocking; the server queues it."""

from collections import OrderedDict
from pathlib import Path
from threading import Lock
from typing import Any

from mmweaver.core.board import Board
from mmweaver.core.boards import find_board
from mmweaver.core.errors import InputError
from mmweaver.core.presets import PRESETS
from mmweaver.core.radar_config import RadarConfig
from mmweaver.generate import Weaver
from mmweaver.generation import Room
from mmweaver.methods import METHODS
from mmweaver.motion.language.activities import BY_KEY
from mmweaver.motion.mocap.clip import MotionClip
from mmweaver.motion.register_activity import load_activity_plugins
from mmweaver.playback.room import room_playback
from mmweaver.playback.wire import pack
from mmweaver.studio.asked import Asked
from mmweaver.studio.compared import compared
from mmweaver.studio.live import Live
from mmweaver.studio.live_labels import OfferedRecognisers
from mmweaver.studio.recorded import OfferedRecordings
from mmweaver.studio.recovery_options import offer_recovery_options
from mmweaver.studio.rooms import DEMO, OfferedRooms
from mmweaver.studio.sessions import Result, Session, Sessions

FIRST_TEXT = "a person walks towards the radar, then waves with the left hand"
BOARDS = ("typical:0", "typical:1", "typical:2", "ideal")
_MOST_WEAVERS = 12  # each keeps the room that it worked in last


class Workshop:
    """Rooms and weights shared by all sessions."""

    def __init__(
        self,
        rooms: list[Path] | None = None,
        recordings: list[Path] | None = None,
        recognisers: list[Path] | None = None,
    ):
        self.rooms = OfferedRooms(rooms or [])
        self.recordings = OfferedRecordings(recordings or [])
        self.recognisers = OfferedRecognisers(recognisers or [])
        self.sessions = Sessions()
        self._weavers: OrderedDict[tuple[str, str, str, str], Weaver] = OrderedDict()
        self._lock = Lock()

    def warm_up(self) -> None:
        """Reads the first room and makes one sequence in it, so that the first visitor does not wait."""
        name = self.rooms.names[0]
        asked = Asked(room=name, text=(FIRST_TEXT,))
        self._weaver(asked, PRESETS[asked.radar]).generate(self.rooms.get(name), FIRST_TEXT, board=asked.board)

    def offer(self) -> dict[str, Any]:
        """What the page's controls hold."""
        load_activity_plugins()
        names = {DEMO: "bundled sample"}
        return {
            "rooms": [(name, names.get(name, name)) for name in self.rooms.names],
            "radars": [(name, name) for name in PRESETS],
            "methods": [("auto", "network"), ("physics", "physics (ray-traced)")],
            "boards": [(name, name.replace(":", " ")) for name in BOARDS],
            "recognisers": self.recognisers.names,
            "recordings": self.recordings.names,
            "sentences": [activity.example for activity in BY_KEY.values()],
            "text": FIRST_TEXT,
        }

    def room_of(self, session: Session, name: str) -> Room:
        """A room by its id: the session's own or an offered one. Raises InputError."""
        return session.rooms[name].room if name in session.rooms else self.rooms.get(name)

    @staticmethod
    def radar_of(session: Session, name: str) -> RadarConfig:
        """A radar by its id: the session's own or a preset. Raises InputError."""
        if name in session.radars:
            return session.radars[name][1]
        if name not in PRESETS:
            raise InputError(f"unknown radar {name!r}; choose one of the list")
        return PRESETS[name]

    @staticmethod
    def board_of(session: Session, name: str, radar: RadarConfig) -> Board:
        """A board by its id: the session's own, "ideal" or "typical:N". Raises InputError."""
        if name in session.boards:
            return find_board(session.boards[name][1], radar)
        if name != "ideal" and not name.startswith("typical:"):
            raise InputError(f"unknown board {name!r}; choose one of the list")
        return find_board(name, radar)

    @staticmethod
    def motion_of(session: Session, name: str | None) -> MotionClip | None:
        """A motion that the session brought; None for None. Raises InputError."""
        if name is not None and name not in session.motions:
            raise InputError("this motion is no longer kept; open its file again")
        return None if name is None else session.motions[name][1]

    def room_bytes(self, session: Session, name: str, radar: str) -> bytes:
        """A room, packed for the page, with the places where this radar sees a person."""
        label = session.rooms[name].label if name in session.rooms else name
        range_m = self.radar_of(session, radar).range_m
        shown = room_playback(self.room_of(session, name).scene, label, (float(range_m[0]), float(range_m[-1])))
        return pack(shown.header, shown.arrays)

    def generate(self, session: Session, body: Any) -> bytes:
        """A sequence, kept in the session and packed for the page. Raises InputError."""
        asked = Asked.of(body)
        room = self.room_of(session, asked.room)
        radar, motion = self.radar_of(session, asked.radar), self.motion_of(session, asked.motion)
        weaver, board = self._weaver(asked, radar), self.board_of(session, asked.board, radar)
        with offer_recovery_options(asked):
            generation = weaver.generate(room, motion=motion, board=board, **asked.request)
        if asked.room in session.rooms:
            options, call = list(session.rooms[asked.room].options), session.rooms[asked.room].call
        else:
            options, call = self.rooms.options(asked.room), self.rooms.call(asked.room)
        names = {
            "radar": session.radars[asked.radar][0] if asked.radar in session.radars else asked.radar,
            "board": session.boards[asked.board][0] if asked.board in session.boards else asked.board,
            "motion": None if asked.motion is None else session.motions[asked.motion][0],
        }
        repeated = {"command": asked.command(options, **names), "python": asked.python(call, **names)}
        result = Result(
            cube=generation.cube, points=generation.points, poses=generation.poses, meta=generation.meta,
            scene=generation.scene, generation=generation, asked=repeated,
            with_samples=lambda: weaver.generate(room, motion=motion, board=board, keep_adc=True, **asked.request),
        )  # fmt: skip
        return self._kept(session, result, {"seconds": generation.stages.seconds, **repeated})

    def recording(self, session: Session, name: str) -> bytes:
        """An offered recording, kept in the session and packed for the page. Raises InputError."""
        return self._kept(session, self.recordings.get(name), {})

    @staticmethod
    def compare(session: Session, a: str, b: str) -> dict[str, Any]:
        """The numbers of two kept results. Raises InputError."""
        return compared(session.result(a), session.result(b))

    def result_bytes(self, session: Session, name: str) -> bytes:
        """A kept result, packed for the page."""
        return self._packed(session.result(name), name, {})

    def live(self, session: Session, body: Any) -> Live:
        """A stream in one of the session's rooms. Raises InputError."""
        asked = Asked.of(body)
        radar = self.radar_of(session, asked.radar)
        board = self.board_of(session, asked.board, radar)
        room = self.room_of(session, asked.room)
        if asked.recogniser is None:
            return Live(self._weaver(asked, radar), room, asked, board)
        recogniser = self.recognisers.get(asked.recogniser)  # learned from the points of a board's firmware
        return Live(Weaver(method=asked.method, radar=radar, points="firmware"), room, asked, board, recogniser)

    def end(self, session: Session) -> None:
        """Ends a session; what was prepared for its rooms, radars and boards goes with it."""
        own = {*session.rooms, *session.radars, *session.boards}
        with self._lock:
            for key in [key for key in self._weavers if own & set(key)]:
                del self._weavers[key]
        self.sessions.end(session)

    def _kept(self, session: Session, result: Result, more: dict[str, Any]) -> bytes:
        name = session.add(result)
        self.sessions.keep_within_memory()
        return self._packed(result, name, more)

    @staticmethod
    def _packed(result: Result, name: str, more: dict[str, Any]) -> bytes:
        shown = result.playback()
        return pack({**shown.header, **more, "result": name}, shown.arrays)

    def _weaver(self, asked: Asked, radar: RadarConfig) -> Weaver:
        """A generator for this room, radar, board and method; kept, because it holds what it prepared for the room."""
        if asked.method not in METHODS:
            raise InputError(f"unknown method {asked.method!r}; choose one of the list")
        key = (asked.room, asked.radar, asked.board, asked.method)
        with self._lock:
            if key not in self._weavers:
                self._weavers[key] = Weaver(method=asked.method, radar=radar)
                while len(self._weavers) > _MOST_WEAVERS:
                    self._weavers.popitem(last=False)
            self._weavers.move_to_end(key)
            return self._weavers[key]
