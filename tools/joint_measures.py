"""Measures a motion on its joints alone, without any code of the generator: what a stranger with a stopwatch would do.

All functions take a `Take`: joints (n, 22, 3) in metres in the radar's frame (x right, y away, z up), times, the floor.
"""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

NAMES = tuple(
    """
    pelvis left_hip right_hip spine1 left_knee right_knee spine2 left_ankle right_ankle spine3 left_foot right_foot neck
    left_collar right_collar head left_shoulder right_shoulder left_elbow right_elbow left_wrist right_wrist
    """.split()  # noqa: SIM905
)
SMOOTH_S = 0.25  # longer than the sway of one step


@dataclass(frozen=True)
class Take:
    """Joints of one person, and where things of the room are, by kind: (x, y) of each."""

    time_s: np.ndarray
    joints_m: np.ndarray
    floor_z_m: float
    things_m: dict[str, list[tuple[float, float]]] = field(default_factory=dict)

    def joint(self, name: str) -> np.ndarray:
        return self.joints_m[:, NAMES.index(name)]

    @property
    def rate_hz(self) -> float:
        return float((len(self.time_s) - 1) / (self.time_s[-1] - self.time_s[0]))

    @property
    def pelvis_up_m(self) -> np.ndarray:
        return self.joint("pelvis")[:, 2] - self.floor_z_m

    @property
    def standing_m(self) -> float:
        """Height of the pelvis of a straight body: both leg bones and the height of an ankle."""
        leg = np.linalg.norm(self.joint("left_hip") - self.joint("left_knee"), axis=1)
        shank = np.linalg.norm(self.joint("left_knee") - self.joint("left_ankle"), axis=1)
        return float(np.median(leg + shank)) + 0.09

    @property
    def heading_rad(self) -> np.ndarray:
        """Direction of hips and shoulders from +x towards +y, unwrapped; kept while the body lies."""
        across = self.joint("left_hip") - self.joint("right_hip")
        across = across + self.joint("left_shoulder") - self.joint("right_shoulder")
        return np.unwrap(np.arctan2(-across[:, 0], across[:, 1]))

    def smooth(self, values: np.ndarray, seconds: float = SMOOTH_S) -> np.ndarray:
        from scipy.ndimage import gaussian_filter1d

        return gaussian_filter1d(values, seconds * self.rate_hz, axis=0, mode="nearest")

    def upright(self) -> np.ndarray:
        """Samples before the pelvis first drops below 85 % of its standing height, all if it starts below."""
        low = self.pelvis_up_m < 0.85 * self.standing_m
        if low[0] or not low.any():
            return np.arange(len(low))
        return np.arange(int(np.argmax(low)))


def _net(take: Take) -> np.ndarray:
    walk = take.upright()
    place = take.joint("pelvis")[walk, :2]
    return place[-1] - place[0]


def towards_m(take: Take) -> float:
    """By how much nearer to the radar the pelvis is when the walk is over."""
    place = take.joint("pelvis")[take.upright(), :2]
    return float(np.hypot(*place[0]) - np.hypot(*place[-1]))


def right_m(take: Take) -> float:
    return float(_net(take)[0])


def ahead_m(take: Take) -> float:
    heading = float(np.median(take.heading_rad[: max(2, int(0.15 * take.rate_hz))]))
    return float(_net(take) @ (np.cos(heading), np.sin(heading)))


def gone_m(take: Take) -> float:
    return float(np.hypot(*_net(take)))


def path_m(take: Take) -> float:
    place = take.smooth(take.joint("pelvis")[take.upright(), :2], 0.12)
    return float(np.hypot(*np.diff(place, axis=0).T).sum())


def crawled_m(take: Take) -> float:
    return float(np.hypot(*(take.joint("pelvis")[-1, :2] - take.joint("pelvis")[0, :2])))


def speed_mps(take: Take) -> float:
    """Median speed of the pelvis while it goes at more than 60 % of its fastest."""
    place = take.smooth(take.joint("pelvis")[take.upright(), :2], 0.3)
    speed = np.hypot(*np.gradient(place, axis=0).T) * take.rate_hz
    inner = speed[int(0.2 * take.rate_hz) : -int(0.2 * take.rate_hz)]
    return float(np.median(inner[inner > 0.6 * inner.max()]))


def steps(take: Take) -> float:
    """Foot strikes: times at which a swinging ankle comes to rest on the floor, both feet."""
    return float(sum(len(_strikes(take, side)) for side in ("left", "right")))


def _strikes(take: Take, side: str) -> np.ndarray:
    ankle = take.smooth(take.joint(f"{side}_ankle"), 0.03)
    speed = np.hypot(*np.gradient(ankle[:, :2], axis=0).T) * take.rate_hz
    swings = speed > 0.35
    edges = np.diff(swings.astype(int))
    begins, ends = np.flatnonzero(edges > 0), np.flatnonzero(edges < 0)
    found = []
    for end in ends:
        begun = begins[begins < end]
        start = begun[-1] if len(begun) else 0
        if np.hypot(*(ankle[end, :2] - ankle[start, :2])) > 0.12:
            found.append(end)
    return np.array(found)


def cadence_spm(take: Take) -> float:
    """Steps per minute, from the median time between strikes of one foot."""
    gaps = np.concatenate([np.diff(_strikes(take, side)) for side in ("left", "right")]) / take.rate_hz
    return float(120.0 / np.median(gaps)) if len(gaps) else 0.0


def turn_deg(take: Take) -> float:
    """Change of the heading, positive to the person's left."""
    heading, edge = take.heading_rad, max(2, int(0.1 * take.rate_hz))
    return float(np.degrees(np.median(heading[-edge:]) - np.median(heading[:edge])))


def facing_deg(take: Take, what: str) -> float:
    """Angle between the heading at the end and the direction to what is faced."""
    edge = max(2, int(0.3 * take.rate_hz))
    heading, spot = float(np.median(take.heading_rad[-edge:])), take.joint("pelvis")[-edge:, :2].mean(axis=0)
    ways = {"left": np.pi, "right": 0.0, "away": np.arctan2(spot[1], spot[0]), "radar": np.arctan2(-spot[1], -spot[0])}
    aims = [ways[what]] if what in ways else [np.arctan2(y - spot[1], x - spot[0]) for x, y in take.things_m[what]]
    return float(min(abs(np.degrees((aim - heading + np.pi) % (2 * np.pi) - np.pi)) for aim in aims))


def distance_m(take: Take, what: str) -> float:
    """Distance from the pelvis at the end to the middle of a thing."""
    spot = take.joint("pelvis")[-1, :2]
    return float(min(np.hypot(x - spot[0], y - spot[1]) for x, y in take.things_m[what]))


def hand_m(take: Take, what: str) -> float:
    """Nearest distance, over the floor plan, from a wrist to the middle of a thing."""
    wrists = np.concatenate([take.joint("left_wrist"), take.joint("right_wrist")])[:, :2]
    return float(min(np.hypot(*(wrists - np.array(one)).T).min() for one in take.things_m[what]))


def seated(take: Take) -> float:
    """1 where the body sits at the end: pelvis at seat height, trunk upright, feet down."""
    up = float(take.pelvis_up_m[-10:].mean())
    trunk = (take.joint("neck") - take.joint("pelvis"))[-10:].mean(axis=0)
    feet = max(float(take.joint(f"{side}_ankle")[-1, 2]) for side in ("left", "right")) - take.floor_z_m
    return float(0.25 < up < 0.8 * take.standing_m and trunk[2] > 0.5 * np.linalg.norm(trunk) and feet < 0.4)


def fallen(take: Take) -> float:
    """1 where the body is on the floor at the end."""
    return float(take.pelvis_up_m[-10:].mean() < 0.35 and take.joint("neck")[-1, 2] - take.floor_z_m < 0.6)


def fell(take: Take) -> float:
    """1 where the body was on the floor at any time."""
    return float(((take.pelvis_up_m < 0.35) & (take.joint("neck")[:, 2] - take.floor_z_m < 0.6)).any())


def falls(take: Take) -> float:
    """How often the body comes down to the floor."""
    down = take.pelvis_up_m < 0.4
    return float(np.count_nonzero(np.diff(down.astype(int)) > 0) + down[0])


def fall_deg(take: Take) -> float:
    """Direction in which the head falls, from the heading of the upright body, positive to the person's left."""
    on_floor = np.flatnonzero(take.joint("neck")[:, 2] - take.floor_z_m < 0.5)
    if not len(on_floor):
        return float("nan")
    walk = take.upright()
    last = walk[-1] if len(walk) < len(take.time_s) else 0
    trunk = take.joint("neck")[on_floor[0], :2] - take.joint("pelvis")[on_floor[0], :2]
    turned = np.arctan2(trunk[1], trunk[0]) - take.heading_rad[max(last - int(0.2 * take.rate_hz), 0)]
    return float(np.degrees((turned + np.pi) % (2 * np.pi) - np.pi))


def lies_s(take: Take) -> float:
    """Seconds on the floor."""
    down = (take.pelvis_up_m < 0.35) & (take.joint("neck")[:, 2] - take.floor_z_m < 0.6)
    return float(down.sum() / take.rate_hz)


def lasts_s(take: Take) -> float:
    return float(take.time_s[-1] - take.time_s[0])


def count(take: Take, signal: str) -> float:
    """Repetitions: peaks of a signal that rise by more than 35 % of its span above what is around them."""
    from scipy.signal import find_peaks

    base = take.joint("pelvis")
    signals: dict[str, Callable[[], np.ndarray]] = {
        "squat": lambda: -take.pelvis_up_m,
        "jump": lambda: np.minimum(take.joint("left_ankle")[:, 2], take.joint("right_ankle")[:, 2]),
        "bow": lambda: -(take.joint("neck") - base)[:, 2],
        "clap": lambda: -np.linalg.norm(take.joint("left_wrist") - take.joint("right_wrist"), axis=1),
        "rise": lambda: take.pelvis_up_m,
        "sit": lambda: -take.pelvis_up_m,
        "jack": lambda: (take.joint("left_wrist") + take.joint("right_wrist"))[:, 2] / 2 - base[:, 2],
    }
    for side in ("left", "right"):
        signals[f"{side}_wrist"] = lambda side=side: take.joint(f"{side}_wrist")[:, 2] - base[:, 2]
        signals[f"{side}_reach"] = lambda side=side: np.linalg.norm(
            take.joint(f"{side}_wrist") - take.joint(f"{side}_shoulder"), axis=1
        )
        signals[f"{side}_foot"] = lambda side=side: take.joint(f"{side}_ankle")[:, 2]
    values = take.smooth(signals[signal](), 0.04)
    values = np.concatenate([[values[0]], values, [values[-1]]])
    span = float(np.ptp(values))
    padded = np.pad(values, 5, constant_values=values.min())
    return float(len(find_peaks(padded, prominence=0.35 * span, distance=int(0.12 * take.rate_hz))[0])) if span else 0.0


def arm_side(take: Take) -> float:
    """-1 where the left wrist moves much more than the right one relative to the trunk, 1 for the right, 0 for both."""
    return _side(take, "wrist", "spine3")


def leg_side(take: Take) -> float:
    """The same of the ankles."""
    return _side(take, "ankle", "pelvis")


def _side(take: Take, end: str, base: str) -> float:
    left, right = (float(np.std(take.joint(f"{side}_{end}") - take.joint(base), axis=0).sum()) for side in SIDES)
    return 0.0 if max(left, right) < 1.6 * min(left, right) else (-1.0 if left > right else 1.0)


SIDES = ("left", "right")


def higher_foot(take: Take) -> float:
    """-1 where the left foot is off the floor in the middle of the motion, 1 for the right."""
    part = slice(len(take.time_s) // 3, 2 * len(take.time_s) // 3)
    left, right = (float(np.median(take.joint(f"{side}_ankle")[part, 2])) for side in SIDES)
    return 0.0 if abs(left - right) < 0.05 else (-1.0 if left > right else 1.0)


def still_m(take: Take) -> float:
    """How far a foot moves over the floor."""
    return float(
        max(
            np.hypot(
                *(take.smooth(take.joint(f"{side}_ankle")[:, :2], 0.1) - take.joint(f"{side}_ankle")[0, :2]).T
            ).max()
            for side in SIDES
        )
    )


def leans_back(take: Take) -> float:
    """1 where the body sits at the end and its trunk is inclined backwards by 10 degrees or more."""
    trunk = (take.joint("neck") - take.joint("pelvis"))[-20:].mean(axis=0)
    heading = float(np.median(take.heading_rad[-20:]))
    back = -float(trunk[:2] @ (np.cos(heading), np.sin(heading)))
    return float(0.25 < take.pelvis_up_m[-1] < 0.8 * take.standing_m and np.degrees(np.arctan2(back, trunk[2])) > 10)


def worst_sole_m(take: Take) -> float:
    """Largest height over, or depth below, the floor of a sole that carries weight.

    A foot carries weight while neither heel nor ball moves over the floor; its height is that of the lower of the two.
    """
    worst = 0.0
    for side in SIDES:
        ankle, ball = take.joint(f"{side}_ankle"), take.joint(f"{side}_foot")
        along = ball - ankle
        level = np.hypot(along[:, 0], along[:, 1])
        length = float(np.median(np.linalg.norm(along, axis=1)))
        rest_rad = np.arcsin(0.034 / np.hypot(0.034, 0.075))  # a foot of these proportions
        pitch = -np.arctan2(along[:, 2], level) - rest_rad
        unit = length / np.hypot(0.034, 0.075)
        heel = ankle[:, 2] - unit * (0.046 * np.cos(pitch) - 0.026 * np.sin(pitch))
        toe = ball[:, 2] - 0.012 * unit * np.cos(pitch)
        speed = np.hypot(*np.gradient(take.smooth(ankle[:, :2], 0.02), axis=0).T) * take.rate_hz
        low = np.minimum(heel, toe) - take.floor_z_m
        stands = (speed < 0.1) & (low < 0.06)
        if stands.any():
            extreme = low[stands][np.argmax(np.abs(low[stands]))]
            worst = float(extreme) if abs(extreme) > abs(worst) else worst
        deepest = float(low.min())
        worst = deepest if deepest < -abs(worst) else worst
    return worst
