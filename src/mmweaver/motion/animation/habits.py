"""Personal movement habits: amplitude, and tempo variation over tens of seconds. The pace is `people.Person`'s.

A person has the same habits in every movement, so twenty seconds of one person resemble each other more than those of
two. Without them, a recogniser trained on generated motions would learn a single tempo.
"""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from mmweaver.core.seeding import stream
from mmweaver.motion.animation.profiles import bump, plateau

Array = np.ndarray
_SPREAD = 0.06  # of amplitude between people, log-normal
_UNEVEN, _SLOW_HZ = (0.03, 0.14), (0.06, 0.2)  # relative drift of the tempo, and its frequency
_PAUSE_EVERY_S, _PAUSE_S, _SHORTEST_S = (5.0, 25.0), (0.5, 1.1), 4.0
_EDGE_S = 0.6  # at the ends of a step the tempo is even
_RATE_HZ = 60.0


@dataclass(frozen=True, kw_only=True)
class Habits:
    """Habits of one person; the default has none.

    Attributes:
        amplitude: Size of movements relative to the usual one.
        unevenness: Relative variation of the tempo over time.
        drift_hz: Frequency of this variation.
        phase_rad: Its phase at the start of a step.
        pause_every_s: Interval of pauses in a continuous movement.
        pause_s: Duration of a pause.
    """

    amplitude: float = 1.0
    unevenness: float = 0.0
    drift_hz: float = 0.1
    phase_rad: float = 0.0
    pause_every_s: float = np.inf
    pause_s: float = 0.8

    def warped(self, time_s: Float[Array, " n"], start_s: float, end_s: float) -> Float[Array, " n"]:
        """Warps time within a step, so that the tempo drifts and the person pauses now and then.

        Args:
            time_s: Times (n,) in seconds.
            start_s: Start of the step, seconds.
            end_s: End of the step, seconds.

        Returns:
            Times of an even movement reached at `time_s`, C2; identical to `time_s` outside the step, which still
            starts and ends as planned.
        """
        lasts = end_s - start_s
        if lasts < _SHORTEST_S or not (self.unevenness or np.isfinite(self.pause_every_s)):
            return time_s
        fine_s = np.linspace(start_s, end_s, max(int(lasts * _RATE_HZ), 2))
        inside = plateau(fine_s, start_s, end_s, _EDGE_S, _EDGE_S)
        rate = 1 + self.unevenness * inside * np.sin(2 * np.pi * self.drift_hz * (fine_s - start_s) + self.phase_rad)
        pauses_s = np.arange(start_s + 0.6 * self.pause_every_s, end_s - 2 * _EDGE_S, self.pause_every_s)
        for pause_s in pauses_s:
            rate = rate * (1 - 0.9 * bump((fine_s - pause_s) / (2 * self.pause_s)))
        gone_s = np.concatenate([[0.0], np.cumsum(0.5 * (rate[1:] + rate[:-1]))]) * (fine_s[1] - fine_s[0])
        # The residual of drift and pauses is compensated away from the ends, where the tempo is fixed.
        share = np.concatenate([[0.0], np.cumsum(0.5 * (inside[1:] + inside[:-1]))]) * (fine_s[1] - fine_s[0])
        gone_s += (lasts - gone_s[-1]) * share / share[-1]
        from scipy.interpolate import CubicSpline

        within = np.clip(time_s, start_s, end_s)
        reached_s = start_s + np.asarray(CubicSpline(fine_s, gone_s, bc_type=((1, 1.0), (1, 1.0)))(within))
        return reached_s + (time_s - within)


NO_HABITS = Habits()


def habits_of(subject: int) -> Habits:
    """Samples the habits of a person, reproducibly.

    Args:
        subject: Number of the person, see `people.person_of`.

    Returns:
        The habits; the same for the same number.
    """
    rng = stream(subject, "motion", "habits")
    amplitude = np.exp(np.clip(rng.normal(0.0, _SPREAD), -2 * _SPREAD, 2 * _SPREAD))
    return Habits(
        amplitude=float(amplitude),
        unevenness=float(rng.uniform(*_UNEVEN)),
        drift_hz=float(rng.uniform(*_SLOW_HZ)),
        phase_rad=float(rng.uniform(0, 2 * np.pi)),
        pause_every_s=float(rng.uniform(*_PAUSE_EVERY_S)),
        pause_s=float(rng.uniform(*_PAUSE_S)),
    )
