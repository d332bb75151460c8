"""Sentences that describe different people ("she", "an old man"): their heights and tempos would tell the label."""

from collections.abc import Iterable
from dataclasses import replace

from mmweaver.motion.language.described_person import DescribedPerson
from mmweaver.weaver.parsed_request import ParsedRequest


def differing_descriptions(requests: Iterable[ParsedRequest]) -> list[str]:
    """The words of the sentences that describe their person; none where all describe the same kind of person."""
    people = [_described(request) for request in requests]
    if len({replace(one, words="") for one in people}) < 2:
        return []
    return list(dict.fromkeys(one.words for one in people if one.is_described))


def done_by_anybody(request: ParsedRequest) -> ParsedRequest:
    """The request without what its sentence says of the person: the subject alone decides who does it."""
    first, *others = request.people
    if first.plan is None:
        return request
    plan = replace(first.plan, person=DescribedPerson())
    return replace(request, people=(replace(first, plan=plan), *others))


def _described(request: ParsedRequest) -> DescribedPerson:
    plan = request.people[0].plan
    return DescribedPerson() if plan is None else plan.person
