"""Every word that says what is seen is shown by a final step, or the clause's record names it."""

import pytest

from mmweaver.motion.language.plan import APPROXIMATED, DONE, ClauseRecord
from mmweaver.motion.language.sentence import parse
from mmweaver.motion.language.token_coverage import not_covered

LOST = {
    # sides, limbs and ways
    "a person picks up a box from his left": "the side",
    "waving hands around near face": "face",
    "a person raises both arms to his chest": "chest",
    "a person raises the right hand to his face": "face",
    "a man waves forward": "forward",
    "a person claps and walks with the arms apart": "apart",
    "a person limps toward the end of the plane": "toward",
    "a person walks five steps forward, knees slightly bend": "knees",
    "someone claps behind the back": "behind",
    "a person hops sideways on the right foot": "sideways",
    "someone bows with hands together": "together",
    "the person moves their head in circles": "circle",
    "a woman walks five steps, starting with the left foot": "foot",
    # manners and sizes
    "a person walks while boldly turning around": "boldly",
    "a person walks quickly and angrily": "angrily",
    "a person takes two large steps forward": "large",
    "a man jumps high": "high",
    "a person is trying to walk": "trying",
    # things and places
    "a person walks through the door": "door",
    "a person stands on a box": "box",
    "a person walks with a cane": "cane",
    "someone is playing an air banjo": "banjo",
    "a person bends over the patient": "patient",
    # numbers
    "a person sits down and stands up repeatedly": "repeatedly",
    "a man jumps in three different heights": "heights",
    # what another step stands between
    "a man sits down and bows": "after getting up",
    "a person dances jazz, jumping": "one after the other",
    # degrees, one more, the way back, which comes first
    "a person crouches a bit": "bit",
    "a person walks through the room": "through",
    "a human lies on his side": "side",
    "a person walks, doing faster steps in between": "between",
    "a person does a front kick to the head": "head",
    "a person walks in a tight, clockwise circle": "tight",
    "a man is pushed from the right, stumbles to the left and sidesteps back to the place he stood": "way back",
    "kicks a ball, then another one": "another",
    "a person sits down after waving and clapping": "order",
    "a person turns 360 degrees to the right during a jump": "during",
    # a hand of two
    "a person drinks with both hands": "both",
}
SHOWN = (
    "a person walks a few steps forward, then backwards",
    "a person raises both arms and lowers them",
    "someone does two jumping jacks, then jumps up with both legs",
    "a man kicks with the right leg after bending down",
    "she takes a quick step to the right",
    "a person performs a walk with a 90 degree turn to the left",
    "a person sits down on the sofa and stands up quickly",
    "a person leans to the left, then to the right",
    "a man is pushed from the left and stumbles to the right",
    "someone raises both arms out to the sides",
    "a person stands up to his feet and raises the right hand",
    "a man turns to face left",
    "someone shakes the head from side to side",
    "a man raises the left arm, then the right arm, then the left arm",
    "she walks forward three steps, back two steps and forward one step",
    "a person walks and comes to a stop",
    "a person picks up a ball with the right hand and throws it with the left",
    "a man sits down, drinks a cup of coffee and stands up again",
    "a burglar walks in the kitchen",
    "he stirs a pot on the stove",
    "a person spins three times to the left",
    "a person waves with both hands",
    "a person walks 1 m forward, turns around and walks another 1 m forward",
    "a person bows after he waves",
    "a person walks around and stands for a bit",
)
SPOKEN_TWICE = {  # a sentence whose second movement or way no step shows, were its first step left out
    "a person jumps, then claps and jumps again": ["jump", "clap", "jump"],
    "a person walks to the left, then to the right": ["left", "right"],
}


@pytest.mark.parametrize(("sentence", "what"), LOST.items())
def test_words_that_no_step_shows_are_reported(sentence: str, what: str):
    records = [record for record in parse(sentence, in_part=True).clauses if what in record.how]
    assert records
    assert all(record.status == APPROXIMATED for record in records)


@pytest.mark.parametrize("sentence", SHOWN)
def test_nothing_is_reported_where_all_is_shown(sentence: str):
    assert [(record.clause, record.how) for record in parse(sentence).clauses if record.status != DONE] == []


@pytest.mark.parametrize(("sentence", "kinds"), SPOKEN_TWICE.items())
def test_what_is_named_twice_needs_two_steps(sentence: str, kinds: list[str]):

    steps = parse(sentence).steps
    assert len(steps) == len(kinds)
    records = {number: ClauseRecord(record.clause) for number, record in enumerate(parse(sentence).clauses)}
    assert not_covered(sentence, steps, records, set()) == []
    assert not_covered(sentence, steps[:-1], records, set()) != []
