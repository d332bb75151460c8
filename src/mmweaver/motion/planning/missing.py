"""Things that a sentence names and the room lacks: a place of the room stands in for each, or they are refused."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.placed_thing import FURNISHABLE
from mmweaver.core.records import LANDMARK_KINDS, Landmark, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.language.lexicon import TARGETS
from mmweaver.motion.language.places import Place
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.targets import SEATS, describe_found, kinds_of

STAND_IN, FURNISH, REFUSE = "stand-in", "furnish", "refuse"
POLICIES = (STAND_IN, FURNISH, REFUSE)
REACH_M = 0.45  # from the place to stand to a thing that stands in
FREE_M = (0.25, 0.7)  # clearance of the place to stand: at something, with room for the body
COUCH_M, BED_RADIUS_M = 0.8, 1.2  # as in `seating`: width of a couch, and from a bed's middle to a seat on it
_SEAT_KINDS = {"couch": ("couch", "sofa", "settee", "bench"), "chair": ("chair", "armchair", "stool")}
_latest: list[tuple[Scene, tuple[object, ...], Scene]] = []


@dataclass(frozen=True)
class Missing:
    """A thing that a step needs and the room lacks.

    Attributes:
        kind: `Landmark.kind`, or the kind of seat.
        clause: Words of the step.
        is_seat: Whether it is to sit or lie on.
        side: left or right if the sentence says where; else "".
    """

    kind: str
    clause: str
    is_seat: bool = False
    side: str = ""


def missing_things(plan: MotionPlan, scene: Scene) -> list[Missing]:
    """The things that a plan names and the room lacks, each once.

    Args:
        plan: The plan.
        scene: The room.
    """
    found: dict[str, Missing] = {}
    for step in plan.steps:
        for kind, side in _named(step):
            if kind not in found and not _has(scene, kind):
                found[kind] = Missing(kind, step.clause or step.name, side=side)
        seat = step.seat if step.uses_seat or step.direction == "seat" else ""
        kind = _seat_kind(seat)
        if kind and kind not in found and not _has_seat(scene, kind):
            found[kind] = Missing(kind, step.clause or step.name, is_seat=True)
    return list(found.values())


def _named(step: Step) -> Iterator[tuple[str, str]]:
    """Kinds of landmarks that a step goes to, is done at or faces, with the side if one is named."""
    part: Place | None = step.place
    side = ""
    while part is not None:
        side = part.relation if part.relation in ("left", "right") else side
        part = part.also
    part = step.place
    while part is not None:
        yield from ((kind, side) for kind in (part.landmark, part.other) if kind and kind not in ("wall", "corner"))
        part = part.also
    if step.moves and step.target and step.target not in SEATS:
        yield step.target, side
    if step.facing in TARGETS.values() and step.facing != "wall":
        yield step.facing, side


def _has(scene: Scene, kind: str) -> bool:
    if any(mark.kind in kinds_of(kind) for mark in scene.landmarks):
        return True
    return kind in SEATS and bool(scene.seats)


def _seat_kind(word: str) -> str:
    return "bed" if word == "bed" else next((kind for kind, words in _SEAT_KINDS.items() if word in words), "")


def _has_seat(scene: Scene, kind: str) -> bool:
    """Whether the room has a seat of a kind; a room without any gets an assumed stool for a chair."""
    beds = [np.asarray(mark.position_m[:2]) for mark in scene.landmarks if mark.kind == "bed"]

    def on_bed(place: np.ndarray) -> bool:
        return any(float(np.hypot(*(np.asarray(place)[:2] - bed))) < BED_RADIUS_M for bed in beds)

    if kind == "bed":
        return any(on_bed(seat.position_m) for seat in scene.seats)
    wide = [seat.size_m[0] >= COUCH_M for seat in scene.seats if not on_bed(seat.position_m)]
    return any(wide) if kind == "couch" else not all(wide)


def with_stand_ins(plan: MotionPlan, floor: FloorMap, policy: str, seed: int) -> tuple[Scene, tuple[str, ...]]:
    """The room with a stand-in for each thing that it lacks.

    Args:
        plan: The plan.
        floor: Floor of the room.
        policy: stand-in or furnish (what could not be furnished gets a stand-in), or refuse.
        seed: Seed of the places.

    Returns:
        The room, and a note for each stand-in that quotes the clause.

    Raises:
        InputError: With refuse, for the first missing thing.
    """
    scene, missing = floor.scene, missing_things(plan, floor.scene)
    if not missing:
        return scene, ()
    if policy == REFUSE:
        raise InputError(_refusal(missing[0], scene))
    notes, marks = [], []
    for one in missing:
        if one.is_seat:
            notes.append(_seat_note(one, scene))
            continue
        mark = _stand_in(one, floor, seed)
        if mark is None:
            raise InputError(_refusal(one, scene))
        marks.append(mark)
        x, y = mark.position_m[:2]
        notes.append(
            f"{one.clause!r}: no {one.kind} is in the picture; the place at x {x:.1f} m, y {y:.1f} m stands for it"
        )
    return (_with_marks(scene, marks) if marks else scene), tuple(notes)


def _with_marks(scene: Scene, marks: list[Landmark]) -> Scene:
    """The room with more landmarks; the same object for the same ones, because maps of a room are cached."""
    key = tuple((mark.kind, *np.round(mark.position_m, 3).tolist()) for mark in marks)
    for room, own, found in _latest:
        if room is scene and own == key:
            return found
    found = replace(scene, landmarks=(*scene.landmarks, *marks))
    _latest[:] = [(scene, key, found), *_latest][:8]
    return found


def _seat_note(one: Missing, scene: Scene) -> str:
    instead = "a seat that is there" if scene.seats else "an assumed stool"
    return f"{one.clause!r}: no {one.kind} to sit on is in the picture; {instead} is used"


def _refusal(one: Missing, scene: Scene) -> str:
    kind, what = kinds_of(one.kind)[0], f"{one.kind} to sit on" if one.is_seat else one.kind
    own = f" put one there with --furnish {one.kind}=X,Y," if one.kind in FURNISHABLE else ""
    if not one.is_seat:
        own = (
            f" give its position with --landmark {kind}=X,Y (metres right of and ahead of the radar) or a class mask"
            f" (--classes),{own}"
        )
    return (
        f"for {one.clause!r}: no {what} was found in the photo; {describe_found(scene)};{own} or let a place of the"
        " room stand for it with --missing stand-in"
    )


def _stand_in(one: Missing, floor: FloorMap, seed: int) -> Landmark | None:
    """A landmark at an edge of the free floor: at a wall or a piece of furniture."""
    from scipy.ndimage import distance_transform_edt

    cells = np.argwhere(floor.walkable)
    if not len(cells):
        return None
    indices = distance_transform_edt(floor.is_free, return_distances=False, return_indices=True)
    centres = floor.cell_centres_m
    places = centres[cells[:, 0], cells[:, 1]]
    nearest = np.asarray(indices)[:, cells[:, 0], cells[:, 1]]
    edges = centres[nearest[0], nearest[1]]
    gaps = edges - places
    clearance = np.hypot(*gaps.T)
    side = {"left": places[:, 0] < 0.0, "right": places[:, 0] > 0.0}.get(one.side, np.ones(len(places), bool))
    is_edge = side & (clearance >= FREE_M[0]) & (clearance <= FREE_M[1])
    for mask in (is_edge, side, np.ones(len(places), bool)):
        if mask.any():
            break
    kept = np.flatnonzero(mask)
    middle = float(np.median(places[:, 1]))
    order = kept[np.argsort(np.abs(places[kept, 1] - middle), kind="stable")]
    rng = stream(seed, "motion", "stand-in", one.kind)
    pick = int(order[int(rng.integers(max(1, len(order) // 3)))])
    away = gaps[pick] / max(float(clearance[pick]), 1e-6)
    if clearance[pick] < 1e-6:
        away = np.array([0.0, 1.0])
    at = places[pick] + max(REACH_M, min(float(clearance[pick]), FREE_M[1])) * away
    kind = one.kind if one.kind in LANDMARK_KINDS else kinds_of(one.kind)[0]
    return Landmark(
        kind=kind,
        position_m=np.array([at[0], at[1], floor.scene.floor_z_m + 1.0]),
        approach_m=(float(places[pick, 0]), float(places[pick, 1])),
        facing_rad=float(np.arctan2(away[1], away[0])),
    )
