"""The lexicon: words that a sentence may contain, by their function. Lists of words stand in `lexicon.toml`."""

import re
from collections.abc import Callable
from pathlib import Path

from mmweaver.core.records import LANDMARK_KINDS
from mmweaver.core.safe_files.safe_text import read_toml
from mmweaver.motion.language.gesture_phrases import GESTURE_PHRASES
from mmweaver.motion.language.phrases import ACTIVITY_PHRASES
from mmweaver.motion.language.sided_phrases import SIDED_PHRASES
from mmweaver.motion.language.sport_phrases import SPORT_PHRASES
from mmweaver.motion.language.verbs import words_in

_WORDS = {name: words_in(words) for name, words in read_toml(Path(__file__).with_suffix(".toml")).items()}

# These mean walking if the clause gives a destination.
GOING = frozenset({"go", "move", "head", "come", "return"})
# A word for a place to go to -> Landmark.kind.
TARGETS = {
    **{kind: kind for kind in LANDMARK_KINDS},
    **dict.fromkeys(("doorway", "exit", "entrance", "doors"), "door"),
    "sofa": "couch", "settee": "couch", "armchair": "chair",
    "stool": "chair", "bookshelf": "shelf", "bookcase": "shelf", "shelves": "shelf", "worktop": "counter",
    "countertop": "counter", "television": "tv", "refrigerator": "fridge", "closet": "wardrobe", "oven": "stove",
    "cupboard": "cabinet", "windows": "window",
}  # fmt: skip
LIGHT = _WORDS["light"]
IRREGULAR = {
    "sat": "sit", "stood": "stand", "drank": "drink", "ran": "run", "strode": "stride",
    "went": "go", "gone": "go", "came": "come", "made": "make", "did": "do", "does": "do", "done": "do", "took": "take",
    "gave": "give", "began": "begin", "kept": "keep", "leapt": "leap", "threw": "throw", "goes": "go",
    "froze": "freeze", "fell": "fall", "ate": "eat", "wrote": "write", "lying": "lie", "knelt": "kneel",
    "laying": "lie", "shook": "shake", "bowed": "bow", "spun": "spin",
    "seated": "seated", "has": "have", "had": "have",
}  # fmt: skip
BASE_VERB_SPEED = {"stroll": -1, "amble": -1, "saunter": -1, "sprint": 1, "march": 0}

# Replaced in this order before anything is looked up.
PHRASES: tuple[tuple[str, str | Callable[[re.Match[str]], str]], ...] = (
    (r"\bfor (?:a|quite a) (?:little |short |long )?while\b", " "),
    *SPORT_PHRASES,
    *SIDED_PHRASES,
    *GESTURE_PHRASES,
    *ACTIVITY_PHRASES,
    (r"\b(left|right)[- ]hand side\b", r"\1 side"),
    (r"\band after (?=(?!this|that|which|his|its|a few)[a-z]+(?:s|ed)\b)", " then "),
    (r"\b(?:lays|laying) (?:it|them)(?: back)?(?: down)?\b", " put_down "),
    (r"\bjump(?:s|ing)?[- ](?:n|an|and)[- ]?jacks?\b", " jumping_jack "),
    (r"\bjumping[- ]?jacks?\b|\bstar[- ]?jumps?\b|\bjump(?:s|ed)?[- ]jacks?\b", " jumping_jack "),
    (r"\bshadow[- ]box", "shadowbox"),
    (r"\bsits? (?:back )?down\b|\bsat (?:back )?down\b|\bsitting (?:back )?down\b", " sit_down "),
    (r"\b(?:takes?|took|taking|has|having) a seat\b", " sit_down "),
    (r"\b(?:stand|stands|stood|standing|get|gets|got|getting|rise|rises|rose|rising) (?:back )?up\b", " stand_up "),
    (r"\b(?:comes?|came|coming) back up\b(?! (?:the|some|to) )", " stand_up "),
    (r"\b(?:rises?|rose|rising)\b", " stand_up "),
    (r"\b(?:puts?|holds?|putting|holding|throws?|sticks?|reaches|stretches)"
     r" (up (?:his |her |their |its |the |both |left |right )*(?:hands?|arms?))\b", r" raise \1 "),
    (r"\b(?:puts?|holds?|putting|holding|throws?|sticks?|reaches|stretches)"
     r" ((?:his |her |their |its |the |both |left |right |one )*(?:hands?|arms?)"
     r" (?:up|in the air|into the air|overhead|above))\b", r" raise \1 "),
    (r"\bhand[- ]?raises?\b|\barm[- ]?raises?\b|\braised? hands?\b", " raise hand "),
    (r"\bfrom (?:the )?left to (?:the )?right\b", " to the right "),
    (r"\bfrom (?:the )?right to (?:the )?left\b", " to the left "),
    (r"\b(?:left and (?:the |his |her |their |its )?right|right and (?:the |his |her |their |its )?left)"
     r"(?= (?:hand|arm|fist|punch|jab|hook|palm))", " both "),
    (r"\b(?:one after the other|alternat\w+)\b", " both "),
    (r"\bback and forth\b|\bto and fro\b|\bforth and back\b|\bback and forwards?\b|\bup and down the room\b",
     " pacing_to_and_fro "),
    (r"\baround (?:the|in the) (?:room|place)\b", " pacing_to_and_fro "),
    (r"\bup and down (?:the |some )?(?:steps|stairs)\b", " stairs "),
    (r"\b(jump(?:s|ing|ed)?) up and down\b", r"\1 up_and_down"),
    (r"\bup and down\b|\b(?:from )?side to side\b", " "),
    (r"\b(?:starting|beginning|starts?|begins?) (?:with|by|on) (?:the |his |her |their )?(?:left|right)"
     r"(?: (?:leg|foot))?\b",
     " leading-foot "),
    (r"\ban? ((?:(?!person|man|woman|human|few)[a-z]+ ){0,2}?step)\b(?! ladder)", r" one \1 "),
    (r"\b((?:(?:counter|anti)[- ]?)?clockwise) ((?:small |big |large |wide )?circles?)\b", r"\2 \1"),
    (r"\b(?:in|on|along|around)(?: an?| the)?(?: (?:small|big|large|wide|tight|narrow|full|whole|complete|little|slow|"
     r"fast|quick|huge|single|one|two|three|four|few|very|slightly|his|her|its)){0,2} circles?\b"
     r"|\ba (?:full |whole |complete |big |small )?circle\b",
     " in_circle "),
    (r"\b(?:figure|number)[ -](?:of )?(?:an? )?(?:8|eight)\b", " figure-eight "),
    (r"\bto (?:the|his|her|one|their|its) side\b|\b(?:sidewards|sideway|sidewise|laterally|sidewards)\b", " sideways "),
    (r"\b(?:on|in) (?:the |one |a )?(?:same )?(?:spot|place)\b|\bin-place\b", " on_spot "),
    (r"\babout[- ]face\b|\b(?:all the way )?around\b(?= *(?:$|[,.;]|and|then))",
     " around "),
    (r"\bhand stand\b", " handstand "),
    (r"\b(?:up|down|up and down) (?:the |some |a few )?steps\b", " stairs "),
    (r"\b(?:at the same time|simultaneously|meanwhile)\b", " at_once "),
    (r"\bfollowed by\b|\bafter (?:that|this|which)\b|\bafterwards?\b|\bsubsequently\b|\bafter a (?:while|moment)\b",
     " then "),
    (r"\b(?:finally|next|later|eventually|lastly)\b", " then "),
    (r"\bin front of\b", " near "),
    (r"\b(?:kneels?|knelt) (?:down )?on (?:his|her|one|the) (?:left |right )?knees?\b", " kneel_down "),
    (r"\bas well(?: as)?\b|\balso\b|\btoo\b", " "),
    (r"\bhands? together\b", " hands "),
    (r"\bhands and knees\b|\ball fours\b", " allfours "),
    (r"(?<!the )(?<!his )(?<!her )(?<!its )(?<!their )(?<!turns )(?<!turn )(?<!turning )"
     r"\bright (after|before|now)\b", r" \1 "),
    (r"\ba (?:couple|pair) of (times|steps)\b", r" 2 \1 "),
    (r"\b(?:several|many|a few|multiple|some|few) "
     r"((?:(?:more |other |small |large |big |little |short |long |quick |slow )*(?:[a-z]+ )?)??)"
     r"(times|steps|punches|squats|jumps|claps|sips|kicks|hops|strides|bows|lunges)\b", r" 3 \1\2 "),
    (r"\bonce again\b|\bagain\b|\bonce more\b", " again "),
    (r"\bone[- ]two\b", " "),
)  # fmt: skip

DIRECTIONS = {
    **dict.fromkeys(("left", "leftward", "leftwards"), "left"),
    **dict.fromkeys(("right", "rightward", "rightwards"), "right"),
    **dict.fromkeys(("towards", "toward", "approach", "closer", "nearer", "approaches", "approaching"), "towards"),
    **dict.fromkeys(("away", "retreat", "retreats", "retreating"), "away"),
    **dict.fromkeys(("forward", "forwards", "ahead", "straight", "onward", "advance", "advances"), "forwards"),
    **dict.fromkeys(("backward", "backwards", "back", "rear", "reverse"), "backwards"),
    "back_to_start": "back",
    "in_circle": "circle",
    "on_spot": "spot",
    "around": "around",
    "pacing_to_and_fro": "pacing",
}
SPEEDS = {
    **dict.fromkeys(
        ("slow", "slowly", "leisurely", "lazily", "carefully", "cautiously", "gently", "calmly", "softly",
         "gradually"), -1
    ),
    **dict.fromkeys(
        ("fast", "quick", "quickly", "briskly", "brisk", "rapidly", "rapid", "hurriedly", "swiftly", "swift",
         "energetically",
         "vigorously", "hastily", "faster", "enthusiastically", "hurries"), 1
    ),
}  # fmt: skip
NUMBERS = {
    "one": 1, "two": 2, "three": 3, "four": 4, "five": 5, "six": 6, "seven": 7, "eight": 8, "nine": 9, "ten": 10,
    "eleven": 11, "twelve": 12, "fifteen": 15, "twenty": 20, "once": 1, "twice": 2, "thrice": 3, "single": 1,
    "another": 1,
}  # fmt: skip
TIMES = frozenset({"once", "twice", "thrice"})
SEATS = _WORDS["seats"]
ARMS = _WORDS["arms"]
RADAR = _WORDS["radar"]
BOTH = _WORDS["both"]
OWN = _WORDS["own"]
PRONOUNS = _WORDS["pronouns"]

NEGATIONS = _WORDS["negations"]
MANY = _WORDS["many"]
NOT_HUMAN = _WORDS["not_human"]
OTHER_MOVEMENT = _WORDS["other_movement"]
FILLERS = _WORDS["fillers"]
MANNERS = _WORDS["manners"]
SIZES = _WORDS["sizes"]
PASSED = _WORDS["passed"]
STEPPING = GOING | _WORDS["stepping"]
DISTANCES = _WORDS["distances"]
LEG_VERBS = _WORDS["leg_verbs"]
FLOOR_VERBS = _WORDS["floor_verbs"]
THINGS = _WORDS["things"]
BEFORE_NOUNS = _WORDS["before_nouns"]
NOUNS_LIKE_VERBS = _WORDS["nouns_like_verbs"]
# What the spelling correction knows in addition to verbs.
ALL_WORDS = frozenset().union(
    ARMS,
    BOTH,
    DIRECTIONS,
    FILLERS,
    MANNERS,
    MANY,
    NEGATIONS,
    NOT_HUMAN,
    NUMBERS,
    OTHER_MOVEMENT,
    RADAR,
    SEATS,
    SIZES,
    SPEEDS,
    TARGETS,
)
