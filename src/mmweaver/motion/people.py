"""The person who moves: height, build, pace and handedness, sampled from a population or described by the sentence.

Adults: stature and girth after the 2012 anthropometric survey of US Army personnel (Gordon et al., NATICK/TR-15/007).
Old people are 4 cm shorter (Sorkin et al., Am. J. Epidemiol. 150, 1999: from 30 to 70 years men lose 3 cm and women
5 cm) and walk at three quarters of the pace (after Bohannon and Andrews, Physiotherapy 97, 2011: means from 1.43 m/s,
men of 40 to 49 years, to 0.94 m/s, women of 80 to 99). Children are about 7 to 11 years old, after the CDC growth
charts of 2000. Heights of teenagers, toddlers and babies, and girths of all the young, are round figures of our own
(babies have the minimum supported height); all have the proportions of adults. Children walk as fast as adults, with
more steps. Their pace on the spot (1.15: shorter limbs swing faster, by the square root of the height) and that of
toddlers and babies are chosen, not measured. One person in ten is left-handed (Papadatou-Pastou et al., Psychol. Bull.
2020: 10.6 %).
"""

from dataclasses import dataclass, replace

import numpy as np

from mmweaver.core.errors import InputError
from mmweaver.core.seeding import stream
from mmweaver.motion.animation.skeleton_proportions import ALLOWED_M
from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.motion.language.plan import MotionPlan

MOST_SUBJECTS = 10_000
ADULT_M = {"male": (1.756, 0.069), "female": (1.629, 0.064)}  # mean, standard deviation
YOUNG_M = {"baby": (0.81, 0.01), "toddler": (0.85, 0.03), "child": (1.33, 0.07)}
TEENAGER_M = {"male": (1.68, 0.08), "female": (1.61, 0.065)}
OLD_SHORTER_M = 0.04
MAX_SDS = 2.5  # maximum number of standard deviations from the mean
TALL_SDS = (1.0, 2.0)  # of "tall"; negated for "short"
GIANT_SDS = (4.0, 5.0)  # of "giant"; negated for "dwarf"
# relative to the average man's, at equal height
GIRTH = {"male": 1.0, "female": 0.96, "baby": 1.05, "toddler": 1.0, "child": 0.84, "teenager": 0.92}
GIRTH_SPREAD = 0.07
HEAVY, SLIM = (1.14, 1.3), (0.8, 0.9)
PACE_SPREAD = 0.05
LEFT_HANDED = 0.1


@dataclass(frozen=True, kw_only=True)
class Person:
    """One person. The default is the average man of his height, at the usual pace, with no preferred hand.

    Attributes:
        height_m: Height in metres.
        subject: Number that identifies skin and micro-motion.
        sex: female or male; "" if not sampled.
        age: baby, toddler, child, teenager, adult or old.
        girth: Thickness of trunk and limbs relative to an average body of this height.
        pace: Tempo relative to the usual one.
        pace_on_the_spot: The same for activities on the spot.
        hand: Preferred hand: left or right.
        described: Words of the sentence that describe the person.
    """

    height_m: float
    subject: int = 0
    sex: str = ""
    age: str = "adult"
    girth: float = 1.0
    pace: float = 1.0
    pace_on_the_spot: float = 1.0
    hand: str = ""
    described: str = ""

    @property
    def note(self) -> str:
        """Sentence that reports how a described person was interpreted."""
        build = "slim" if self.girth < 0.91 else "heavy" if self.girth > 1.1 else "of average build"
        who = f"a {self.sex} {self.age}".replace(" old", " old person").replace("  ", " ")
        pace = "" if 0.9 < self.pace < 1.1 else f", at {self.pace:.2f} of the usual pace"
        of_both = abs(self.pace_on_the_spot - self.pace) < 1e-6
        on_spot = "" if of_both else f", on the spot at {self.pace_on_the_spot:.2f} of the usual pace"
        return f"{self.described!r} is taken as {who} {self.height_m:.2f} m tall, {build}{pace}{on_spot}"


def subject_of(seed: int, index: int = 0) -> int:
    """Samples the subject of a person.

    Args:
        seed: Seed of the sequence.
        index: Index of the person in the sequence.

    Returns:
        Number from 0 to 9999.
    """
    return int(stream(seed, "motion", "subject", *([index] if index else [])).integers(MOST_SUBJECTS))


def check_subject(subject: int) -> int:
    """Validates a subject and returns it.

    Args:
        subject: Number of the person.

    Raises:
        InputError: If it is not between 0 and 9999.
    """
    if not 0 <= subject < MOST_SUBJECTS:
        raise InputError(f"a subject is a number from 0 to {MOST_SUBJECTS - 1}, not {subject}")
    return subject


def person_of(subject: int, described: DescribedPerson | None = None, height_m: float | None = None) -> Person:
    """The person with a given number: always the same, except for traits that the sentence or `height_m` fixes.

    Args:
        subject: Number of the person, 0 to 9999.
        described: Traits from the sentence; None samples all of them.
        height_m: Height of the body in metres, overriding the description.

    Raises:
        InputError: If the number is out of range.
    """
    traits = described or DescribedPerson()
    rng = stream(check_subject(subject), "motion", "person")
    draws = rng.random(3)  # sex, hand, build: always sampled, so that a description changes nothing else
    sds, pace_sds, girth_sds = np.clip(rng.normal(size=3), -MAX_SDS, MAX_SDS)
    sex = traits.sex or ("male" if draws[0] < 0.5 else "female")
    if traits.stature:
        usual_sds = GIANT_SDS if abs(traits.stature) > 1 else TALL_SDS
        sds = float(np.sign(traits.stature) * np.interp(draws[2], (0, 1), usual_sds))
    mean, spread = YOUNG_M.get(traits.age) or (TEENAGER_M if traits.age == "teenager" else ADULT_M)[sex]
    if traits.age == "old":
        mean -= OLD_SHORTER_M
    low, high = ALLOWED_M
    drawn_m = float(np.clip(mean + spread * sds, low + 0.02, high))
    if height_m is None:
        height_m = traits.height_m or drawn_m
    girth = GIRTH[traits.age if traits.age in GIRTH else sex] * float(np.exp(GIRTH_SPREAD * girth_sds))
    if traits.build:
        girth = float(np.interp(draws[2], (0, 1), HEAVY if traits.build > 0 else SLIM))
    own_pace, usual_pace = float(np.exp(PACE_SPREAD * pace_sds)), (traits.pace(moves=True), traits.pace(moves=False))
    return Person(
        height_m=height_m,
        subject=subject,
        sex=sex,
        age=traits.age or "adult",
        girth=round(girth, 4),
        pace=own_pace * usual_pace[0],
        pace_on_the_spot=own_pace * usual_pace[1],
        hand="left" if draws[1] < LEFT_HANDED else "right",
        described=traits.words if traits.is_described else "",
    )


def apply_habits(plan: MotionPlan, person: Person) -> MotionPlan:
    """Adapts a plan to a person: their pace and their preferred hand.

    Args:
        plan: Plan of the sentence.
        person: The person who acts.

    Returns:
        The plan with pace and preferred hand in every step.
    """
    steps = tuple(
        replace(step, pace=person.pace if step.moves else person.pace_on_the_spot, usual_hand=person.hand)
        for step in plan.steps
    )
    return replace(plan, steps=steps)
