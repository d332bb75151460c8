"""The front of every sentence: text in, MotionPlan out. The parser in use is chosen here and nowhere else."""

from typing import Protocol

from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse


class SentenceParser(Protocol):
    """Reads what a person does."""

    def __call__(self, text: str, *, in_part: bool = False) -> MotionPlan:
        """The steps of a sentence in temporal order, not scheduled yet.

        Args:
            text: the sentence.
            in_part: whether clauses that are not understood are recorded as not done, where at least as many are.

        Returns:
            The plan, with a record of every clause: done, approximated or not done.

        Raises:
            InputError: where the sentence is not understood; one line says what of it, and what is known.
        """


parse_sentence: SentenceParser = parse
