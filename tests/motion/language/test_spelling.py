import pytest

from mmweaver.motion.language.words import correct_spelling, corrected_word


def test_slips_are_mended_and_told():
    text, notes = correct_spelling("a person wlaks forwads")
    assert text == "a person walks forwards"
    assert notes == ["'wlaks' is read as 'walks'", "'forwads' is read as 'forwards'"]
    assert corrected_word("backwrads") == "backwards"
    assert corrected_word("wawing") == "waving"


@pytest.mark.parametrize(
    ("slip", "word"),
    [
        ("wlks", "walks"), ("trun", "turn"), ("wvaes", "waves"), ("jmups", "jumps"), ("sqaut", "squat"),
        ("nosd", "nods"), ("kncks", "knocks"),
        ("hnads", "hands"), ("rihgt", "right"), ("bhind", "behind"), ("joggs", "jogs"),
    ],
)  # fmt: skip
def test_slips_in_short_words(slip: str, word: str):
    assert corrected_word(slip) == word


def test_short_words_that_may_be_others_stay():
    for word in (
        "stes", "sists", "wals", "able", "ever", "says", "seas", "good", "track", "scare", "caps", "pants", "quiet",
        "tried", "steep", "clam", "east", "dose", "fits", "hoops", "spies", "angel", "cha", "tsk", "mens",
        "singing", "showing", "passes", "walk", "licking", "talking", "swinging", "slides", "combing", "folded",
    ):  # fmt: skip
        assert corrected_word(word) == "", word


def test_names_stay():
    assert correct_spelling("Boyd walks, then Wien turns") == ("Boyd walks, then Wien turns", [])
