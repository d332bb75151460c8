"""Consecutive sentences without a break: each motion begins with the pose and velocity with which the last one ended.

Motions are composed one by one, each from the position, heading and posture in which the last one ended. The residual
between the two (position of the hands, stance of the feet) fades, see `animation.carry_over`.
Reference: docs/decisions/streams.md.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.errors import InputError, NoRoomError
from mmweaver.core.records import PoseSequence, Scene
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.assemble import RATE_HZ, dense_times
from mmweaver.motion.animation.carry_over import ControlsState
from mmweaver.motion.animation.skeleton_proportions import SkeletonProportions
from mmweaver.motion.compose import Motion, compose
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.motion.language.plan_resumption import HELD_FIRST_S, continued, goes_on, posture_held
from mmweaver.motion.language.sentence import parse_sentence
from mmweaver.motion.language.timing import natural_s, schedule
from mmweaver.motion.people import Person, apply_habits, person_of, subject_of
from mmweaver.motion.planning.body_state import BodyState
from mmweaver.motion.planning.floor_map import FloorMap
from mmweaver.motion.planning.missing import STAND_IN
from mmweaver.motion.planning.placement import Conditions
from mmweaver.motion.planning.seating import preferred, usable_seats
from mmweaver.motion.verification.verify import check_done

IDLE_S = 10.0  # duration of a part without a new sentence
HISTORY_S = 2.5  # of the previous motion, kept for windows that reach back in time
WALK_ON_S = 2.5
WALKS_ON = "there is no room for this where the person is: they walk on first"
_NOTHING_SAID = "a person stands"


@dataclass(frozen=True, kw_only=True)
class MotionPart:
    """The motion of one sentence, or of waiting for the next one, on the time axis of the whole stream.

    Attributes:
        pose: Motion at 120 Hz, time since the stream's first frame; begins HISTORY_S before the part.
        first_frame: First radar frame of the part.
        num_frames: Number of radar frames.
        text: The sentence in force.
        motion: The composed motion, on its own time axis.
        refused: Why the sentence could not be carried out; "" if it was.
    """

    pose: PoseSequence
    first_frame: int
    num_frames: int
    text: str
    motion: Motion
    refused: str = ""

    @property
    def end_frame(self) -> int:
        return self.first_frame + self.num_frames


class ContinuousMotion:
    """Composes part after part for one person in one room; the same seed and sentences give the same motion.

    Args:
        scene: The room, in the radar's frame.
        frame_period_s: Time per radar frame in seconds; parts last whole frames.
        range_window_m: Nearest and farthest slant range in metres that the radar keeps.
        farthest_m: Maximum range in metres with all range bins, for advice in error messages.
        seed: Determines what the sentences leave open.
        start_m: Start position (x, y) in metres; None chooses one.
        heading_rad: Initial heading in radians, from +x towards +y; None chooses one.
        height_m: Height of the body in metres; None takes the described or the subject's height.
        subject: Number of the person; None samples it by the seed.
        missing: What is done about things that a sentence names and the room lacks, as for `compose`.
        strict: Whether a sentence of which something is not done is refused.
    """

    def __init__(
        self,
        scene: Scene,
        first: Conditions,
        *,
        frame_period_s: float,
        range_window_m: tuple[float, float],
        farthest_m: float = math.inf,
        height_m: float | None = None,
        subject: int | None = None,
        missing: str = STAND_IN,
        strict: bool = False,
    ) -> None:
        self.scene, self.frame_period_s, self.range_window_m = scene, frame_period_s, range_window_m
        self._missing, self._strict = missing, strict
        self._first, self._farthest_m = first, farthest_m  # start and heading are those of the first part
        self._height_m, self._subject = height_m, subject_of(first.seed) if subject is None else subject
        self._person: Person | None = None
        self._parts = 0
        self._last: MotionPart | None = None
        self._end: BodyState | None = None
        self._said: MotionPlan | None = None  # the last plan of a sentence

    def act(self, plan: MotionPlan) -> MotionPart:
        """Composes the motion of a parsed sentence, from the end of the last part.

        Args:
            plan: Plan of the sentence; it need not be scheduled.

        Returns:
            The next part.

        Raises:
            InputError: If there is no room for the motion.
        """
        person = self._person or person_of(self._subject, plan.person, self._height_m)
        before = None if self._end is None else _held(self._end, HELD_FIRST_S)
        usual = apply_habits(plan, person)
        try:
            whole = continued(usual, before, seat_m=self._way_to_seat_m(plan, person))
            part = self._compose(whole, person, plan.text, may_touch=False)
        except NoRoomError:
            part = self._walked_on(usual, before, plan, person) or self._compose(whole, person, plan.text)
        self._said = plan
        return part

    def _walked_on(self, usual: MotionPlan, before: Step | None, plan: MotionPlan, person: Person) -> MotionPart | None:
        """The plan preceded by a walk to free floor; None if the body cannot walk, or there is none."""
        if before is None or before.posture != "feet" or plan.steps[0].moves:
            return None
        walk = replace(plan.steps[0], lower="walk", upper="", direction=None, seconds=WALK_ON_S)
        walked = replace(usual, steps=(walk, *usual.steps), notes=(*usual.notes, WALKS_ON))
        try:
            return self._compose(continued(walked, before), person, plan.text, may_touch=False)
        except NoRoomError:
            return None

    def go_on(self, refused: str = "") -> MotionPart:
        """Continues without a new sentence: the last activity goes on, or the posture is held.

        Args:
            refused: Why the last sentence could not be carried out; the posture is then held.

        Returns:
            The next part; never raises after the first sentence.
        """
        person = self._person or person_of(self._subject, None, self._height_m)
        if self._end is None or self._last is None:
            return self._compose(_lasting(parse_sentence(_NOTHING_SAID), IDLE_S), person, "")
        step = None if refused or self._said is None else goes_on(self._said, IDLE_S)
        if step is not None and step.posture == self._end.posture:
            try:
                return self._compose(replace(self._base(), steps=(step,)), person, self._last.text)
            except InputError:
                pass
        held = replace(self._base(), steps=(_held(self._end, IDLE_S),))
        return replace(self._compose(held, person, self._last.text), refused=refused)

    def cut(self, end_frame: int) -> None:
        """Ends the last part at an earlier frame, because a new sentence has arrived.

        Args:
            end_frame: Frame of the stream after the last one of the part.
        """
        assert self._last is not None
        self._last = replace(self._last, num_frames=end_frame - self._last.first_frame)

    def _base(self) -> MotionPlan:
        return parse_sentence(_NOTHING_SAID) if self._said is None else replace(self._said, notes=(), clauses=())

    def _compose(self, plan: MotionPlan, person: Person, text: str, *, may_touch: bool = True) -> MotionPart:
        number = self._parts
        frames = max(1, math.ceil(natural_s(plan) / self.frame_period_s - 1e-6))
        scheduled = schedule(plan, frames * self.frame_period_s)
        seed = self._first.seed if number == 0 else int(stream(self._first.seed, "stream", number).integers(2**31))
        is_first = self._end is None
        motion = compose(
            scheduled,
            self.scene,
            seed=seed,
            range_window_m=self.range_window_m,
            person=person,
            after=self._state(),
            start_m=self._first.start_m if is_first else None,
            heading_rad=self._first.heading_rad if is_first else None,
            may_touch=may_touch,
            farthest_m=self._farthest_m,
            missing=self._missing,
        )
        if self._strict:
            check_done(text, motion.clauses)
        begins = 0 if self._last is None else self._last.end_frame
        begin_s = begins * self.frame_period_s
        before = None if self._last is None else self._last.pose
        pose = joined(before, motion.pose, begin_s)
        part = MotionPart(pose=pose, first_frame=begins, num_frames=frames, text=text, motion=motion)
        end = motion.end
        if end is not None and end.sitting is None and self._end is not None and _stays(motion):
            end = replace(end, sitting=self._end.sitting)
        self._parts, self._last, self._end, self._person = number + 1, part, end, person
        return part

    def _state(self) -> BodyState | None:
        """State of the body at the frame at which the last part actually ends."""
        if self._last is None or self._end is None:
            return None
        motion, ended_s = self._last.motion, self._last.num_frames * self.frame_period_s
        assert motion.controls is not None
        state = ControlsState.at(motion.controls, dense_times(motion.plan.duration_s), ended_s)
        return replace(self._end, controls=state)

    def _way_to_seat_m(self, plan: MotionPlan, person: Person) -> float | None:
        """Distance to the nearest seat that the sentence refers to; None if the body already stands in front of one."""
        if self._end is None or self._end.posture != "feet" or self._end.sitting is not None:
            return None
        floor = FloorMap.of(self.scene, self.range_window_m, person.height_m)
        seats = usable_seats(floor, SkeletonProportions(person.height_m))
        meant = preferred(seats, plan.steps[0].seat, self.scene)
        if not meant:
            return None
        return float(min(np.hypot(*(seat.feet_m - np.array(self._end.position_m))) for seat in meant))


def _held(state: BodyState, seconds: float) -> Step:
    return posture_held(state.posture, seconds=seconds, style=state.style, foot=state.foot)


def _lasting(plan: MotionPlan, seconds: float) -> MotionPlan:
    return replace(plan, steps=tuple(replace(step, seconds=seconds) for step in plan.steps))


def _stays(motion: Motion) -> bool:
    return not any(step.moves or step.lower == "turn" or step.turn_deg for step in motion.plan.steps)


def joined(before: PoseSequence | None, pose: PoseSequence, begin_s: float) -> PoseSequence:
    """Appends a motion to the recent history of the one before it, on one time axis.

    Args:
        before: Motion so far; None for the first part.
        pose: Motion whose time starts at 0.
        begin_s: Time on the stream's axis at which `pose` begins, seconds.

    Returns:
        The last HISTORY_S of `before`, then `pose`.
    """
    if before is None:
        return replace(pose, time_s=pose.time_s + begin_s)
    new = pose.time_s > -1e-9
    old = (before.time_s > begin_s - HISTORY_S) & (before.time_s < begin_s - 0.5 / RATE_HZ)
    return replace(
        pose,
        time_s=np.concatenate([before.time_s[old], begin_s + pose.time_s[new]]),
        joints_m=np.concatenate([before.joints_m[old], pose.joints_m[new]]),
    )
