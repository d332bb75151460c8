import pytest

from mmweaver.motion.language.activities import BODY, HANDS, PARAPHRASES
from mmweaver.motion.language.suggestions import not_known


@pytest.mark.parametrize(
    ("clause", "example"),
    [("searches something", "looks around"), ("a person on the sofa swings a bat", "plays golf"), ("xyzzy", ""),
     ("a backflip on the table", ""), ("a person does the cobra pose", ""), ("knits a scarf", "")],
)  # fmt: skip
def test_the_unknown_words_suggest_an_activity(clause: str, example: str):
    message = not_known(clause)
    assert example in message
    assert ("did you mean" in message) == bool(example)


def test_paraphrases_are_of_known_activities():
    assert set(PARAPHRASES) <= {activity.key for activity in (*BODY, *HANDS)}
