import pytest

from mmweaver.motion.empty_floor import NOBODY, says_nobody


@pytest.mark.parametrize(
    "text",
    [
        NOBODY, "Nobody.", "no one", "no-one is there", "nobody is in the room", "there is nobody in the room",
        "an empty room", "the empty living room", "the room is empty", "a room with nobody in it",
        "the room without people", "an empty room with nobody in it", "  AN  EMPTY ROOM ",
    ],
)  # fmt: skip
def test_sentences_of_an_empty_place(text: str):
    assert says_nobody(text)


@pytest.mark.parametrize(
    "text",
    [
        "", "nobody waves", "a person walks through an empty room", "somebody is in the room", "empty",
        "he empties the room", "nobody but him is there", "a person leaves the room empty", "nobody walks in the room",
    ],
)  # fmt: skip
def test_sentences_in_which_somebody_is_or_does_something(text: str):
    assert not says_nobody(text)
