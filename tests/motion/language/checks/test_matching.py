"""Mentions against slots: in order, in any order, each slot once."""

from mmweaver.motion.language.checks.matching import (
    not_shown_as_often,
    out_of_order,
    shown_at_all,
    shown_in_order,
)

FIRST, SECOND, EITHER = frozenset({0}), frozenset({1}), frozenset({0, 1})


def test_a_slot_shows_one_mention() -> None:
    """Two mentions and one step that is like both."""
    assert len(shown_at_all(2, [[EITHER]])) == len(shown_in_order(2, [[EITHER]])) == 1
    assert list(not_shown_as_often(["stumbles", "stumbles"], ["stumble"] * 2, [[EITHER]])) == [
        (1, "'stumbles' is shown once, not twice")
    ]


def test_other_words_for_a_movement_have_none_of_their_own() -> None:
    assert list(not_shown_as_often(["turns", "spins"], ["turn", "spin"], [[EITHER]])) == [
        (1, "'spins' has no movement of its own")
    ]
    assert list(not_shown_as_often(["kick"], ["kick"], [[frozenset()]])) == [(0, "'kick' is not shown")]


def test_steps_in_another_order_are_found() -> None:
    assert out_of_order(2, [[SECOND], [FIRST]]) == 1
    assert out_of_order(2, [[FIRST], [SECOND]]) is None


def test_what_a_step_shows_at_once_has_no_order() -> None:
    assert out_of_order(2, [[SECOND, FIRST]]) is None


def test_a_mention_gives_way_where_another_slot_fits() -> None:
    """The first mention fits both slots, the second only the first."""
    assert shown_at_all(2, [[EITHER], [FIRST]]) == {0: 1, 1: 0}
