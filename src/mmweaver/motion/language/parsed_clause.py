"""A clause with its steps, and the effect of a clause without an activity on the previous steps."""

from dataclasses import dataclass, field, replace

from mmweaver.core.errors import InputError
from mmweaver.motion.language.lexicon import NUMBERS, SPEEDS, TIMES
from mmweaver.motion.language.modifiers import OPPOSITE
from mmweaver.motion.language.plan import Step, Way
from mmweaver.motion.language.verb_steps import GAITS, facing_of, target_of
from mmweaver.motion.language.words import Word


@dataclass
class ParsedClause:
    """Steps and modifiers of one clause.

    Attributes:
        link: Relation to the previous clause, see `Clause`.
        text: Words of the clause.
        steps: Steps of its verbs.
        form: Form of the first verb: ing, s, ...
        forms: Form of each step's verb.
        about: Direction, hand, speed, ... of a clause without a verb.
        notes: Assumptions.
        approximations: Deviations from the sentence.
        unknown: Unknown words.
        number: Position of the clause in the sentence.
        words: Words of the clause.
        lost: As `approximations`, found after all clauses are parsed.
        in_turn: Whether its report states that movements are shown one after the other.
    """

    link: str
    text: str
    steps: list[Step] = field(default_factory=list)
    form: str = ""
    forms: list[str] = field(default_factory=list)
    about: Step = field(default_factory=Step)
    notes: list[str] = field(default_factory=list)
    approximations: list[str] = field(default_factory=list)
    unknown: list[str] = field(default_factory=list)
    number: int = 0
    words: list[Word] = field(default_factory=list)
    lost: list[str] = field(default_factory=list)
    in_turn: bool = False

    @property
    def adds_nothing(self) -> bool:
        """Whether it names no activity, only modifiers: "and slowly", "and arm"."""
        return not self.steps and not self.unknown

    @property
    def says_times(self) -> bool:
        """Whether it states a number of repetitions: 'twice', 'multiple times'."""
        return any(word.text in TIMES or word.text == "times" for word in self.words)

    @property
    def is_empty(self) -> bool:
        return self.adds_nothing and replace(self.about, clause="") == Step()

    @property
    def speed_of_both(self) -> int:
        """Speed that also applies to the previous movement: "forwards and backwards slowly"; 0 for none."""
        ends_with_it = bool(self.words) and self.words[-1].text in SPEEDS
        return self.about.speed if ends_with_it and self.link in ("and", "comma") else 0

    def say_in_turn(self, one: Step, other: Step) -> None:
        """Reports that two movements are shown one after the other."""
        self.lost.append(f"{one.name} and {other.name} are shown one after the other")
        self.in_turn = True

    def absorb(self, more: "ParsedClause") -> None:
        """Applies the modifiers of a clause without an activity to the last step.

        Args:
            more: The clause that follows.

        Raises:
            InputError: If the two name contradictory directions.
        """
        about = more.about
        self.take_its_speed(more)
        last = self.steps[-1]
        comes_back = more.link == "and" and about.direction == Way.BACK and last.direction in (None, Way.SEAT)
        if comes_back and last.lower in GAITS and last.moves:  # "walks to the door and back"
            back = replace(
                last, direction=Way.BACK, target="", seat="", place=None, clauses=(*last.clauses, more.number)
            )
            self.steps.append(_same_length(about, back))
            self.forms.append("s")
            return
        if last.direction and about.direction and last.direction != about.direction:
            if last.moves and self._leads_back(last, more):
                return
            raise InputError(
                f"{self.text!r} and {more.text!r} name two directions; say which movement goes where, with 'then'"
            )
        self.steps[-1] = replace(
            last,
            hand="both" if {last.hand, about.hand} == {"left", "right"} else last.hand or about.hand,
            direction=last.direction or about.direction,
            speed=last.speed or about.speed,
            count=_count_of(last, more),
            seat=last.seat or about.seat,
            seconds=last.seconds or about.seconds,
            clauses=(*last.clauses, more.number),
            place=last.place or about.place,
            distance_m=last.distance_m or about.distance_m,
            target=last.target or (target_of(more.words) if last.lower in ("walk", "jog") else ""),
            facing=last.facing or facing_of(more.words),
            foot=last.foot or about.foot,
        )

    def go_on(self, more: "ParsedClause") -> None:
        """Adds a step like the last one in another direction.

        Args:
            more: The clause that follows, without an activity.
        """
        about = more.about
        self.take_its_speed(more)
        last = self.steps[-1]
        count = about.count or next((NUMBERS[word.text] for word in more.words if word.text in NUMBERS), 0)
        aside = count in (1, 2) or any(word.text == "sideways" for word in more.words)
        lower = "sidestep" if aside else last.lower
        self.steps.append(
            replace(
                last,
                lower=lower,
                direction=about.direction,
                count=count,
                speed=about.speed or last.speed,
                distance_m=about.distance_m,
                seconds=about.seconds,
                clauses=(*last.clauses, more.number),
            )
        )
        self.forms.append("s")

    def take_its_speed(self, more: "ParsedClause") -> None:
        """Applies the speed that the following clause states for both."""
        self.steps[-1] = replace(self.steps[-1], speed=self.steps[-1].speed or more.speed_of_both)

    def _leads_back(self, last: Step, more: "ParsedClause") -> bool:
        """'Walks forwards and backwards', 'steps aside and then back': the other direction is a step of its own."""
        about, number = more.about, more.number
        if last.lower == "sidestep":
            other = OPPOSITE.get(last.direction)
            if about.direction not in (Way.BACK, Way.BACKWARDS, other) or not other:
                return False
            other_way = {"direction": other}
        elif (
            about.direction in (Way.BACK, Way.BACKWARDS, Way.FORWARDS)
            and last.lower in ("walk", "jog")
            and not last.arc_deg
        ):
            other_way = {"direction": about.direction}
        else:
            return False
        self.steps.append(_same_length(about, replace(last, **other_way, clauses=(*last.clauses, number))))
        self.forms.append("s")
        return True


def _count_of(last: Step, more: ParsedClause) -> int:
    """Repetitions of the last step: 'does a kick, three times' is three, 'walks, three times' no number of paces."""
    if more.says_times:
        return last.count if last.lower in GAITS else max(more.about.count, last.count)
    return last.count or more.about.count


def _same_length(about: Step, walk: Step) -> Step:
    """A walk with speed and length of the clause that continues it; the previous length if it states none."""
    says_how_far = bool(about.count or about.seconds or about.distance_m)
    own = about if says_how_far else walk
    return replace(
        walk, speed=about.speed or walk.speed, seconds=about.seconds, count=own.count, distance_m=own.distance_m
    )
