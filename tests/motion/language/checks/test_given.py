"""The sentence word by word."""

from mmweaver.motion.language.checks.given import given
from mmweaver.motion.language.plan import ClauseRecord, Step

RECORDS = {0: ClauseRecord("a person walks"), 1: ClauseRecord("did not fall as if dancing")}


def test_words_have_their_clause_and_the_steps_of_it() -> None:
    walk, stand = Step(lower="walk", clauses=(0,)), Step(clauses=(1,))
    sentence = given("A person walks but did not fall as if dancing.", [walk, stand], RECORDS, set())
    words = {token.text: token for token in sentence.tokens}
    assert sentence.own(words["walks"]) == [walk]
    assert sentence.own(words["fall"]) == [stand]
    assert words["walks"].part != words["fall"].part
    assert sentence.token_at(sentence.text.index("fall")) == words["fall"]


def test_what_is_denied_or_compared_names_no_movement() -> None:
    sentence = given("A person walks but did not fall as if dancing.", [Step(lower="walk")], RECORDS, set())
    assert {sentence.tokens[place].text for place in sentence.compared} >= {"fall", "dancing"}


def test_misspelled_words_are_corrected_and_plurals_kept() -> None:
    texts = [token.text for token in given("a person walks forwads in all directions", [Step()], RECORDS, set()).tokens]
    assert texts == ["a", "person", "walks", "forwards", "in", "all", "directions"]
