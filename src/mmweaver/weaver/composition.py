"""The motion of a request in a room: composed, verified, and in a wider range window where the sentence needs it."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.options import Place
from mmweaver.core.radar_config import RadarConfig
from mmweaver.core.range_window import with_range
from mmweaver.core.records import Breathing, Scene
from mmweaver.core.seeding import stream
from mmweaver.core.targets import Thing
from mmweaver.motion.compose import Motion
from mmweaver.motion.mocap.clip_placement import place_clip
from mmweaver.motion.multi_person import compose_people
from mmweaver.motion.people import subject_of
from mmweaver.motion.physiology import held_breaths
from mmweaver.motion.planning.missing import FURNISH, missing_things
from mmweaver.motion.verification.verify import check_done
from mmweaver.weaver.generation import Room
from mmweaver.weaver.parsed_request import ParsedRequest, PersonRequest

NEAREST_M, FARTHEST_M, MARGIN_M = 0.3, 12.0, 0.3  # of widened windows: limits, and beyond the body
GAIN = 0.05  # less loss than this is not worth another window
LOST_BY_ERROR = 10.0
MAX_RECENT = 64  # compositions that are kept: matched draws try a sequence before it is generated
_recent: deque[tuple[Scene, tuple[object, ...], tuple[Motion, ...]]] = deque(maxlen=MAX_RECENT)


def compose_request(request: ParsedRequest, scene: Scene) -> tuple[Motion, ...]:
    """Composes the motion of each person; a recorded motion replaces that of the first.

    Args:
        request: The parsed request.
        scene: The room in the camera's coordinates.

    Returns:
        One motion per person, without collisions with the room and each other.

    Raises:
        InputError: If the room has no space for the motion, or, with `request.strict`, something is not done.
    """
    if not request.people:
        return ()
    key = (request.people, request.config, request.frames, request.seed, request.heading_rad, request.missing)
    known = next((people for room, own, people in _recent if room is scene and own == key), None)
    people = known if known is not None and request.motion is None else _composed(request, scene)
    if known is None and request.motion is None:
        _recent.append((scene, key, people))  # matched draws have tried what they generate
    for person in people if request.strict else ():
        check_done(person.plan.text, person.clauses)
    return people


def _composed(request: ParsedRequest, scene: Scene) -> tuple[Motion, ...]:
    recorded, first = None, request.people[0]
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
    people = compose_people(
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
        missing=request.missing,
    )
    return tuple(_breathing(*pair) for pair in zip(people, request.people, strict=True))


def lost_of(people: Sequence[Motion]) -> float:
    """How much the joints of all people lose of what their sentences ask for."""
    steps = [step for person in people for step in person.verified]
    return float(sum(0.1 + deviation.lost for step in steps for deviation in step.deviations))


def widened(request: ParsedRequest, scene: Scene) -> tuple[ParsedRequest, tuple[Motion, ...]]:
    """Composes a request in the radar's window, or, if the room has more floor and the sentence needs it, a wider one.

    Args:
        request: The parsed request.
        scene: The room.

    Returns:
        The request, with the window that it needs, and the motions; an assumption of the first states the window.

    Raises:
        InputError: If no window serves.
    """
    first_error: InputError | None = None
    people: tuple[Motion, ...] = ()
    try:
        people = compose_request(request, scene)
    except InputError as error:
        first_error = error
    lost = LOST_BY_ERROR if first_error is not None else lost_of(people)
    wide = _wide(request.config, scene) if lost > 0 else None
    if wide is None:
        if first_error is not None:
            raise first_error
        return request, people
    try:
        more = compose_request(replace(request, config=wide), scene)
    except InputError:
        if first_error is not None:
            raise first_error from None
        return request, people
    if lost_of(more) > lost - GAIN:
        return request, people
    config = _narrowed(request.config, wide, more)
    (near, far), (old_near, old_far) = _window(config), _window(request.config)
    note = (
        f"the range window is widened from {old_near:.2f} to {old_far:.2f} m to {near:.2f} to {far:.2f} m, which the"
        " sentence needs in this room; --range sets it"
    )
    first = replace(more[0], assumptions=(*more[0].assumptions, note))
    return replace(request, config=config), (first, *more[1:])


def _window(config: RadarConfig) -> tuple[float, float]:
    return float(config.range_m[0]), float(config.range_m[-1])


def _wide(config: RadarConfig, scene: Scene) -> RadarConfig | None:
    """The window from close by to the farthest floor of the room; None if it is no wider."""
    free = scene.free_space
    is_free = free.is_free if free.is_assumed is None else free.is_free | free.is_assumed
    if not is_free.any():
        return None
    x, y = np.meshgrid(free.x_m, free.y_m)
    floor_m = float(np.sqrt(x[is_free] ** 2 + y[is_free] ** 2 + scene.floor_z_m**2).max())
    near, far = _window(config)
    reach = min(floor_m + MARGIN_M, config.farthest_bin_m, FARTHEST_M)
    if reach <= far + 0.05 and near <= NEAREST_M + 0.05:
        return None
    return with_range(config, min(near, NEAREST_M), max(reach, far))


def _narrowed(config: RadarConfig, wide: RadarConfig, people: Sequence[Motion]) -> RadarConfig:
    """The smallest window that keeps the usual one and all bodies."""
    reach = np.concatenate([np.linalg.norm(person.pose.joints_m, axis=-1).ravel() for person in people])
    (near, far), (least, most) = _window(config), _window(wide)
    return with_range(
        config,
        max(min(near, float(reach.min()) - MARGIN_M), least),
        min(max(far, float(reach.max()) + MARGIN_M), most),
    )


def furnished_room(request: ParsedRequest, room: Room) -> Room:
    """The room with furniture in place of what the sentences name and it lacks, if the request asks for that.

    Args:
        request: The parsed request.
        room: The room.
    """
    if request.missing != FURNISH:
        return room
    from mmweaver.scene.furnished import free_place

    for plan in filter(None, (person.plan for person in request.people)):
        for one in missing_things(plan, room.scene):
            place = free_place(room.scene, one.kind, request.range_window_m[1], seed=request.seed, side=one.side)
            if place is not None:  # else a place of the room stands in for it
                room = room.with_furniture(place, seed=request.seed)
    return room


def with_targets(room: Room, request: ParsedRequest) -> Room:
    """The room with the things and reflectors of a request, each thing at its place or at a free one.

    Args:
        room: The room in the camera's coordinates.
        request: The parsed request.

    Raises:
        InputError: For reflectors in front of a background recording, which does not hold them.
    """
    if not request.things and not request.reflectors and not request.interferers:
        return room
    if request.reflectors and room.background is not None:
        raise InputError("a background recording has its own echoes; leave out the reflector or the background")
    things: list[Thing] = []
    for number, thing in enumerate(request.things):
        seed = int(stream(request.seed, "thing", number).integers(2**31))
        taken = [one.place_m for one in (*things, *request.things) if one.place_m is not None]
        place = thing.place_m or free_place(room.scene, request.range_window_m, seed, taken)
        things.append(replace(thing, place_m=place, seed=seed))
    targets = {"things": tuple(things), "reflectors": request.reflectors, "interferers": request.interferers}
    return replace(room, scene=replace(room.scene, **targets))


def free_place(
    scene: Scene, range_window_m: tuple[float, float], seed: int, taken: Sequence[Place] = ()
) -> tuple[float, float]:
    """A free place on the floor in the radar's view, for a thing.

    Args:
        scene: The room in the camera's coordinates.
        range_window_m: Nearest and farthest range that the radar keeps.
        seed: Seed of the place.
        taken: Places (x, y) to keep 0.8 m away from where there is room.
    """
    space, rng = scene.free_space, stream(seed, "thing place")
    x, y = np.meshgrid(space.x_m, space.y_m)
    distance = np.hypot(x, y)
    good = space.is_free & (distance > max(range_window_m[0], 1.0)) & (distance < min(range_window_m[1], 5.0))
    good &= np.abs(np.arctan2(x, y)) < np.radians(40)
    apart = good & np.all([np.hypot(x - one[0], y - one[1]) > 0.8 for one in taken] or [good], axis=0)
    cells = np.argwhere(apart if apart.any() else good)
    if not len(cells):  # a room without free floor: beyond the person's usual place
        return 0.6, float(np.clip(2.5, *range_window_m))
    row, column = cells[rng.integers(len(cells))]
    return float(space.x_m[column]), float(space.y_m[row])


def _breathing(motion: Motion, person: PersonRequest) -> Motion:
    """The motion with the breathing that the text asks for, and under the blanket that it names."""
    asked = Breathing(per_minute=person.breaths_per_minute, held_s=held_breaths(motion.plan.steps))
    if asked == Breathing() and not person.cover_db:
        return motion
    return replace(motion, pose=replace(motion.pose, breathing=asked, cover_db=person.cover_db))
