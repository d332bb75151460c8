"""Entry point of sentence parsing: text in, MotionPlan out. The parser in use is chosen here only."""

from typing import Protocol

from mmweaver.motion.language.plan import MotionPlan
from mmweaver.motion.language.sentence import parse


class SentenceParser(Protocol):
    """Interface of a parser of sentences."""

    def __call__(self, text: str, *, in_part: bool = False) -> MotionPlan:
        """The steps of a sentence in temporal order, not scheduled yet.

        Args:
            text: The sentence.
            in_part: Whether clauses that are not understood are recorded as not done, if at least as many are.

        Returns:
            The plan, with a record of every clause: done, approximated or not done.

        Raises:
            InputError: If the sentence is not understood; one line states the part, and what is known.
        """


parse_sentence: SentenceParser = parse
