"""Facts of a motion, measured on its joints: lengths, speeds, turns, facing, repetitions, limbs, postures, contacts.

Nothing here knows the plan: a span of time goes in, numbers come out. They are stored per clause in meta.json.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Float

from mmweaver.core.records import PoseSequence
from mmweaver.core.skeleton import joint

Array = np.ndarray
SIDES = ("left", "right")
SWAY_S, CRUISE_S = 0.12, 0.3  # smoothing of the pelvis before its path, and its speed, are measured
MOVING_SHARE = 0.6  # of the highest speed above which a body is under way
EDGE_S = 0.12  # at either end of a span, over which a heading is averaged
LOW_PELVIS, SEAT_PELVIS = 0.36, 0.8  # pelvis height of a lying and below which that of a seated body, share of standing
PEAK_SHARE = 0.35  # of a signal's span by which a repetition stands out
STILL_M, NOD_M = 0.06, 0.015  # span below which a signal of trunk or limbs, or of the head, is sway
SLOW_S = 0.35  # slower parts of a signal are its posture: a raised arm that waves
MOVES, RAISED = 0.5, 0.08  # way of a limb in lengths of it, above which it moves; height above which it is raised
OFF_FLOOR_M = 0.05
ONE_SIDED = 1.25  # ratio of two limbs' movement above which one of them moves
MIN_PEAK_S = 0.12  # between repetitions
SWING_MPS, STRIDE_M = 0.35, 0.12  # speed of a swinging foot, and length above which a swing is a step


@dataclass(frozen=True, kw_only=True)
class Facts:
    """What a body does in a span of time; lengths over the floor follow the pelvis.

    Attributes:
        start_s: Start in seconds.
        duration_s: Duration in seconds.
        path_m: Length of the path.
        net_m: Displacement (x right, y away from the radar).
        towards_m: Decrease of the distance from the radar.
        ahead_m: Displacement along the heading of the body while it moves.
        left_m: Displacement to the body's own left.
        speed_mps: Median speed while under way.
        turn_deg: Change of heading, positive to the person's left.
        heading_rad: Heading at the end, from +x towards +y.
        place_m: Place (x, y) at the end.
        posture: Support at the end: feet, seat, knees or floor.
        lowest_posture: The lowest posture at any time.
        fall_deg: Direction from pelvis to head once on the floor, from the heading before, positive to the left.
        repetitions: Peaks that the signals of a movement show, the strongest first.
        arm: left, right, both or "" (none moves or is held out).
        leg: The same of legs.
        steps: Foot strikes, the step that brings the feet together among them.
        cadence_spm: Steps per minute; 0 if no foot strikes twice.
        sole_m: Height of the soles over the floor, smallest and largest while the feet carry weight.
    """

    start_s: float
    duration_s: float
    path_m: float
    net_m: tuple[float, float]
    towards_m: float
    ahead_m: float
    left_m: float
    speed_mps: float
    turn_deg: float
    heading_rad: float
    place_m: tuple[float, float]
    posture: str
    lowest_posture: str
    fall_deg: float | None
    repetitions: tuple[int, ...]
    arm: str
    leg: str
    steps: int
    cadence_spm: float
    sole_m: tuple[float, float]

    @property
    def off_radar_deg(self) -> float:
        """Angle between the heading at the end and the direction to the radar, 0 to 180 degrees."""
        return abs(self.angle_to_deg((0.0, 0.0)))

    def angle_to_deg(self, place_m: tuple[float, float]) -> float:
        """Angle from the heading at the end to a place (x, y), -180 to 180 degrees."""
        aim = np.arctan2(place_m[1] - self.place_m[1], place_m[0] - self.place_m[0])
        return float(np.degrees((aim - self.heading_rad + np.pi) % (2 * np.pi) - np.pi))

    def distance_m(self, place_m: tuple[float, float]) -> float:
        """Distance over the floor from the place at the end to another one."""
        return float(np.hypot(place_m[0] - self.place_m[0], place_m[1] - self.place_m[1]))

    def meta(self) -> dict[str, object]:
        """The facts for meta.json, rounded."""
        found: dict[str, object] = {
            "start_s": round(self.start_s, 2),
            "duration_s": round(self.duration_s, 2),
            "posture": self.posture,
            "off_radar_deg": round(self.off_radar_deg),
        }
        if self.path_m > 0.25:
            found |= {
                "path_m": round(self.path_m, 2),
                "net_m": [round(part, 2) for part in self.net_m],
                "towards_m": round(self.towards_m, 2),
                "speed_mps": round(self.speed_mps, 2),
                "steps": self.steps,
            }
        if abs(self.turn_deg) > 5:
            found["turn_deg"] = round(self.turn_deg)
        if self.repetitions and self.repetitions[0] > 1:
            found["repetitions"] = self.repetitions[0]
        found |= {name: value for name, value in (("arm", self.arm), ("leg", self.leg)) if value}
        return found


class Measurement:
    """Measures spans of one motion.

    Args:
        pose: Joints over time.
        floor_z_m: Height of the floor in the radar's frame.
    """

    def __init__(self, pose: PoseSequence, floor_z_m: float) -> None:
        self._pose, self._floor_z_m = pose, floor_z_m
        time_s = pose.time_s
        self._rate_hz = float((len(time_s) - 1) / max(float(time_s[-1] - time_s[0]), 1e-9))

    def _of(self, name: str) -> Float[Array, "n 3"]:
        return self._pose.joints_m[:, joint(name)]

    @cached_property
    def _place_m(self) -> Float[Array, "n 2"]:
        return self._smooth(self._of("pelvis")[:, :2], SWAY_S)

    @cached_property
    def _heading_rad(self) -> Float[Array, " n"]:
        across = self._of("left_hip") - self._of("right_hip") + self._of("left_shoulder") - self._of("right_shoulder")
        return np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))

    @cached_property
    def _standing_m(self) -> float:
        bones = [np.linalg.norm(self._of("left_hip")[0] - self._of("left_knee")[0])]
        bones.append(np.linalg.norm(self._of("left_knee")[0] - self._of("left_ankle")[0]))
        return float(sum(bones)) + 0.09 * self._pose.height_m / 1.75

    @cached_property
    def _postures(self) -> np.ndarray:
        """Posture of each sample: 0 feet, 1 seat, 2 knees, 3 floor."""
        up = (self._of("pelvis")[:, 2] - self._floor_z_m) / self._standing_m
        knees = np.minimum(self._of("left_knee")[:, 2], self._of("right_knee")[:, 2]) - self._floor_z_m
        trunk = self._of("neck") - self._of("pelvis")
        upright = trunk[:, 2] > 0.5 * np.linalg.norm(trunk, axis=1)
        hips_over_knees = self._of("pelvis")[:, 2] - self._floor_z_m - knees
        found = np.zeros(len(up), int)
        found[(up < SEAT_PELVIS) & upright & (hips_over_knees < 0.3)] = 1
        found[(knees < 0.14) & (up >= LOW_PELVIS)] = 2
        found[(up < LOW_PELVIS) | ((up < SEAT_PELVIS) & ~upright & (knees >= 0.14))] = 3
        return found

    def _smooth(self, values: np.ndarray, seconds: float) -> np.ndarray:
        from scipy.ndimage import gaussian_filter1d

        width = seconds * self._rate_hz
        edge = min(int(4 * width) + 1, len(values) - 1)
        padding = [(edge, edge)] + [(0, 0)] * (values.ndim - 1)
        longer = np.pad(values, padding, mode="reflect", reflect_type="odd")  # a body under way goes on at the ends
        return np.asarray(gaussian_filter1d(longer, width, axis=0))[edge : edge + len(values)]

    def span(self, start_s: float, end_s: float) -> slice:
        """Samples of a span of time, at least three."""
        first, last = np.searchsorted(self._pose.time_s, (start_s, end_s))
        return slice(min(int(first), len(self._pose.time_s) - 3), max(int(last), int(first) + 3))

    def facts(self, start_s: float, end_s: float) -> Facts:
        """Measures a span.

        Args:
            start_s: Start in seconds.
            end_s: End in seconds.
        """
        part = self.span(start_s, end_s)
        place, heading = self._of("pelvis")[part, :2], self._heading_rad[part]
        smooth = self._place_m[part]
        speed = np.hypot(*np.gradient(self._smooth(place, CRUISE_S), axis=0).T) * self._rate_hz
        under_way = speed > max(MOVING_SHARE * float(speed.max()), 0.1)
        moving_rad = float(np.median(heading[under_way])) if under_way.any() else float(heading[0])
        net = place[-1] - place[0]
        edge = max(2, min(int(EDGE_S * self._rate_hz), len(heading) // 3))
        postures, strikes = self._postures[part], self._strikes(part)
        return Facts(
            start_s=start_s,
            duration_s=end_s - start_s,
            path_m=float(np.hypot(*np.diff(smooth, axis=0).T).sum()),
            net_m=(float(net[0]), float(net[1])),
            towards_m=float(np.hypot(*place[0]) - np.hypot(*place[-1])),
            ahead_m=float(net @ (np.cos(moving_rad), np.sin(moving_rad))),
            left_m=float(net @ (-np.sin(moving_rad), np.cos(moving_rad))),
            speed_mps=float(np.median(speed[under_way])) if under_way.any() else 0.0,
            turn_deg=float(np.degrees(np.median(heading[-edge:]) - np.median(heading[:edge]))),
            heading_rad=float(np.median(heading[-edge:])),
            place_m=(float(place[-1, 0]), float(place[-1, 1])),
            posture=_POSTURES[int(np.median(postures[-edge:]))],
            lowest_posture=_POSTURES[int(postures.max())],
            fall_deg=self._fall_deg(part),
            repetitions=self._repetitions(part),
            arm=self._limb(part, "wrist", "shoulder"),
            leg=self._limb(part, "ankle", "hip"),
            steps=sum(map(len, strikes)),
            cadence_spm=self._cadence_spm(strikes),
            sole_m=self._sole_m(part),
        )

    def _fall_deg(self, part: slice) -> float | None:
        down = np.flatnonzero(self._postures[part] == 3)
        if not len(down) or down[0] == 0:
            return None
        first = part.start + int(down[0])
        on_floor = self._of("neck")[first : part.stop, 2] - self._floor_z_m < 0.5
        at = first + int(np.argmax(on_floor)) if on_floor.any() else first
        trunk = self._of("neck")[at, :2] - self._of("pelvis")[at, :2]
        begun = np.flatnonzero(self._of("pelvis")[part, 2] - self._floor_z_m < 0.85 * self._standing_m)
        before = max(part.start + int(begun[0] if len(begun) else 0) - int(0.2 * self._rate_hz), part.start)
        turned = np.arctan2(trunk[1], trunk[0]) - self._heading_rad[before]
        return float(np.degrees((turned + np.pi) % (2 * np.pi) - np.pi))

    def _signals(self, part: slice) -> list[tuple[np.ndarray, float]]:
        """What repeats in a movement, each with the span below which it is sway."""
        pelvis, shoulders = self._of("pelvis")[part], self._of("neck")[part]
        heading = self._heading_rad[part]
        ahead = np.stack([np.cos(heading), np.sin(heading), np.zeros(len(heading))], axis=1)
        left = np.stack([-np.sin(heading), np.cos(heading), np.zeros(len(heading))], axis=1)
        trunk, head = shoulders - pelvis, self._of("head")[part] - shoulders
        apart = np.linalg.norm(self._of("left_wrist")[part] - self._of("right_wrist")[part], axis=1)
        found = [(pelvis[:, 2], STILL_M), (trunk[:, 2], STILL_M), (np.sum(trunk * left, axis=1), STILL_M)]
        found += [(apart, STILL_M), (np.sum(head * ahead, axis=1), NOD_M), (np.sum(head * left, axis=1), NOD_M)]
        for side in SIDES:
            for end, root in (("wrist", "shoulder"), ("wrist", "elbow"), ("ankle", "hip")):
                reach = self._of(f"{side}_{end}")[part] - self._of(f"{side}_{root}")[part]
                found += [(reach[:, 2], STILL_M), (np.sum(reach * ahead, axis=1), STILL_M)]
                found.append((np.sum(reach * left, axis=1), STILL_M))
        return found

    def _repetitions(self, part: slice) -> tuple[int, ...]:
        """Peaks of every signal that moves, up and down, as it is and without its slow part; the largest span first."""
        moving = []
        for signal, still in self._signals(part):
            fine = self._smooth(signal, 0.03)
            for values in (fine, fine - self._smooth(signal, SLOW_S)):
                span = float(np.ptp(values))
                if span > still:
                    moving.append((span / still, values))
        moving.sort(key=lambda one: -one[0])
        counts = [_peaks(sign * values, self._rate_hz) for _, values in moving for sign in (1.0, -1.0)]
        return tuple(dict.fromkeys(counts))

    def _limb(self, part: slice, end: str, root: str) -> str:
        """The limb that moves, or is held away from where it rests if neither does."""
        ways, raised = [], []
        across = self._of(f"left_{root}")[part] - self._of(f"right_{root}")[part]
        ahead = np.stack([across[:, 1], -across[:, 0]], axis=1) / np.linalg.norm(across[:, :2], axis=1)[:, None]
        for side in SIDES:
            reach = self._of(f"{side}_{end}")[part] - self._of(f"{side}_{root}")[part]
            x, y = (np.sum(reach[:, :2] * way, axis=1) for way in (ahead, ahead[:, ::-1] * (-1, 1)))
            reach = np.stack([x, y, reach[:, 2]], axis=1)  # as the trunk turns, an arm at rest keeps still
            length = max(float(np.linalg.norm(reach, axis=1).max()), 1e-6)
            fine = self._smooth(reach, 0.05)
            ways.append(float(np.linalg.norm(np.diff(fine, axis=0), axis=1).sum()) / length)
            raised.append(float(np.quantile(reach[:, 2] + length, 0.9)) / length)
        used = ways if max(ways) > MOVES else raised
        if used is raised and max(raised) < RAISED * (0.6 if end == "ankle" else 1.0):
            return ""
        return "both" if max(used) < ONE_SIDED * min(used) else SIDES[int(np.argmax(used))]

    def _strikes(self, part: slice) -> list[np.ndarray]:
        """Samples at which each foot strikes the floor: ends of swings longer than `STRIDE_M`."""
        found = []
        for side in SIDES:
            ankle = self._smooth(self._of(f"{side}_ankle")[part, :2], 0.03)
            swings = np.hypot(*np.gradient(ankle, axis=0).T) * self._rate_hz > SWING_MPS
            edges = np.diff(np.concatenate([[False], swings, [False]]).astype(int))
            ends = np.flatnonzero(edges < 0)
            gaps = ankle[np.minimum(ends, len(ankle) - 1)] - ankle[np.flatnonzero(edges > 0)]
            found.append(ends[(ends < len(swings)) & (np.hypot(*gaps.T) > STRIDE_M)])
        return found

    def _cadence_spm(self, strikes: list[np.ndarray]) -> float:
        """Steps per minute from the median time between strikes of a foot; 0 without two of either."""
        gaps = np.concatenate([np.diff(one) for one in strikes])
        return float(120 * self._rate_hz / np.median(gaps)) if len(gaps) else 0.0

    def _sole_m(self, part: slice) -> tuple[float, float]:
        """Smallest and largest height of the lower edge of a sole that carries weight."""
        lowest, highest = [0.0], [0.0]
        for side in SIDES:
            ankle, ball = self._of(f"{side}_ankle")[part], self._of(f"{side}_foot")[part]
            low = lower_edge_m(ankle, ball) - self._floor_z_m
            speed = np.hypot(*np.gradient(self._smooth(ankle[:, :2], 0.02), axis=0).T) * self._rate_hz
            carries = (speed < 0.1) & (low < OFF_FLOOR_M)
            lowest.append(float(low.min()))
            highest += [float(low[carries].max())] if carries.any() else []
        return min(lowest), max(highest)

    def hand_distance_m(self, start_s: float, end_s: float, place_m: tuple[float, float]) -> tuple[float, float]:
        """Smallest distance over the floor plan from either wrist to a place, and when it occurs.

        Args:
            start_s: Start in seconds.
            end_s: End in seconds.
            place_m: The place (x, y).

        Returns:
            Metres and seconds.
        """
        part = self.span(start_s, end_s)
        gaps = [np.hypot(*(self._of(f"{side}_wrist")[part, :2] - np.asarray(place_m)).T) for side in SIDES]
        nearest = np.min(gaps, axis=0)
        at = int(np.argmin(nearest))
        return float(nearest[at]), float(self._pose.time_s[part][at])


_POSTURES = ("feet", "seat", "knees", "floor")
_FOOT = (0.075, 0.034, 0.026, 0.046, 0.012)  # ankle to ball ahead and down, heel behind and below, sole below ball


def lower_edge_m(ankle_m: Float[Array, "n 3"], ball_m: Float[Array, "n 3"]) -> Float[Array, " n"]:
    """Height of the lower of heel and ball of a foot, from its ankle and the joint at its ball.

    Args:
        ankle_m: Ankle over time.
        ball_m: Joint at the ball of the foot over time.
    """
    along = ball_m - ankle_m
    ahead, down, heel_behind, heel_down, ball_down = _FOOT
    unit = float(np.median(np.linalg.norm(along, axis=1))) / np.hypot(ahead, down)
    pitch = -np.arctan2(along[:, 2], np.hypot(along[:, 0], along[:, 1])) - np.arctan2(down, ahead)
    heel = ankle_m[:, 2] - unit * (heel_down * np.cos(pitch) - heel_behind * np.sin(pitch))
    return np.minimum(heel, ball_m[:, 2] - unit * ball_down * np.cos(pitch))


def _peaks(values: np.ndarray, rate_hz: float) -> int:
    """Number of peaks that stand out by `PEAK_SHARE` of the span of the values."""
    from scipy.signal import find_peaks

    span = float(np.ptp(values))
    padded = np.pad(values, 3, constant_values=float(values.min()))
    return len(find_peaks(padded, prominence=PEAK_SHARE * span, distance=max(1, int(MIN_PEAK_S * rate_hz)))[0])
