"""Every sentence of a request goes through the one parser that is chosen."""

import pytest

from mmweaver.motion.language import timing
from mmweaver.motion.language.plan import MotionPlan, Step
from mmweaver.weaver import parsed_request


def test_another_parser_takes_the_place_of_the_grammar(monkeypatch: pytest.MonkeyPatch):
    def always_waves(text: str, *, in_part: bool = False) -> MotionPlan:
        return MotionPlan(text=text, steps=(Step(upper="wave", clauses=(0,)),))

    for module in (timing, parsed_request):
        monkeypatch.setattr(module, "parse_sentence", always_waves)
    assert [step.upper for step in timing.plan_motion("a sentence in no grammar").steps] == ["wave"]
