from mmweaver.motion.language.activities import BODY, HANDS, PARAPHRASES
from mmweaver.motion.language.suggestions import nearest, not_known


def test_the_nearest_activity_comes_first():
    assert nearest("swings a bat")[0][2] == "golf"
    assert nearest("drives a car") == [] or nearest("drives a car")[0][0] < 0.9
    assert nearest("") == []
    message = not_known("searches something")
    assert "looks around" in message
    assert "mmweaver motions" in message
    assert "did you mean" not in not_known("xyzzy")


def test_the_unknown_words_alone_suggest():
    for text in ("a backflip on the table", "a person does the cobra pose", "performs a handstand", "knits a scarf"):
        assert "did you mean" not in not_known(text)
    assert "plays golf" in not_known("a person on the sofa swings a bat")


def test_paraphrases_are_of_known_activities():
    assert set(PARAPHRASES) <= {activity.key for activity in (*BODY, *HANDS)}
