"""The words that a sentence may be made of, and what each says."""


def _words(text: str) -> frozenset[str]:
    return frozenset(text.split())


# Verbs (and the nouns made of them, as in "takes a walk"): lemma -> (lower, upper) of a Step. Empty lower: arms only.
ACTIVITY_OF_LEMMA: dict[str, tuple[str, str]] = {
    **dict.fromkeys(("walk", "stroll", "pace", "stride", "amble", "wander", "saunter", "step", "march"), ("walk", "")),
    **dict.fromkeys(("advance", "approach", "retreat"), ("walk", "")),
    **dict.fromkeys(("jog", "run", "sprint", "trot"), ("jog", "")),
    **dict.fromkeys(("turn", "rotate", "pivot", "face"), ("turn", "")),
    **dict.fromkeys(("stand", "wait", "pause", "halt", "stop", "stay", "remain", "freeze", "idle"), ("stand", "")),
    **dict.fromkeys(("sit", "seat", "seated", "sit_down"), ("sit", "")),
    "stand_up": ("stand_up", ""),
    **dict.fromkeys(("squat", "crouch"), ("squat", "")),
    **dict.fromkeys(("jump", "hop", "leap"), ("jump", "")),
    "jumping_jack": ("jumping_jacks", ""),
    **dict.fromkeys(("wave", "greet"), ("", "wave")),
    **dict.fromkeys(("clap", "applaud", "applause"), ("", "clap")),
    **dict.fromkeys(("raise", "lift"), ("", "raise")),
    **dict.fromkeys(("drink", "sip", "gulp"), ("", "drink")),
    **dict.fromkeys(("punch", "box", "jab", "shadowbox"), ("", "punch")),
}
# Moving somewhere: walking, if the clause says where to (or that it is for a walk).
GOING = frozenset({"go", "move", "head", "come", "return"})
# Verbs that say nothing by themselves: "does squats", "starts walking", "keeps waving".
LIGHT = _words(
    """
    do perform make take give start begin continue keep proceed execute practice practise have throw land decide
    """
)
IRREGULAR = {
    "sat": "sit", "stood": "stand", "drank": "drink", "drunk": "drink", "ran": "run", "strode": "stride",
    "went": "go", "gone": "go", "came": "come", "made": "make", "did": "do", "does": "do", "done": "do", "took": "take",
    "gave": "give", "began": "begin", "kept": "keep", "leapt": "leap", "threw": "throw", "goes": "go",
    "froze": "freeze",
    "seated": "seated", "has": "have", "had": "have",
}  # fmt: skip
BASE_VERB_SPEED = {"stroll": -1, "amble": -1, "saunter": -1, "sprint": 1, "march": 0}

PHRASES: tuple[tuple[str, str], ...] = (  # replaced in this order before anything is looked up
    (r"\bjumping[- ]?jacks?\b|\bstar[- ]?jumps?\b|\bjump(?:s|ed)?[- ]jacks?\b", " jumping_jack "),
    (r"\bshadow[- ]box", "shadowbox"),
    (r"\bsits? (?:back )?down\b|\bsat (?:back )?down\b|\bsitting (?:back )?down\b", " sit_down "),
    (r"\b(?:takes?|took|taking|has|having) a seat\b", " sit_down "),
    (r"\b(?:stand|stands|stood|standing|get|gets|got|getting|rise|rises|rose|rising) (?:back )?up\b", " stand_up "),
    (r"\b(?:rises?|rose|rising)\b", " stand_up "),
    (r"\b(?:puts?|holds?|putting|holding|throws?|sticks?|reaches|stretches)"
     r" (up (?:his |her |their |its |the |both |left |right )*(?:hands?|arms?))\b", r" raise \1 "),
    (r"\b(?:puts?|holds?|putting|holding|throws?|sticks?|reaches|stretches)"
     r" ((?:his |her |their |its |the |both |left |right |one )*(?:hands?|arms?)"
     r" (?:up|in the air|into the air|overhead|above))\b", r" raise \1 "),
    (r"\bhand[- ]?raises?\b|\barm[- ]?raises?\b|\braised? hands?\b", " raise hand "),
    (r"\bfrom (?:the )?left to (?:the )?right\b", " to the right "),
    (r"\bfrom (?:the )?right to (?:the )?left\b", " to the left "),
    (r"\b(?:left and (?:the |his |her |their )?right|right and (?:the |his |her |their )?left)\b", " both "),
    (r"\b(?:one after the other|alternat\w+)\b", " both "),
    (r"\bback and forth\b|\bto and fro\b|\bback and forwards?\b|\bup and down the room\b", " pacing_to_and_fro "),
    (r"\baround (?:the|in the) (?:room|place)\b", " pacing_to_and_fro "),
    (r"\bup and down (?:the |some )?(?:steps|stairs)\b", " stairs "),
    (r"\bup and down\b|\b(?:from )?side to side\b", " "),
    (r"\b(?:starting|beginning|starts?|begins?) (?:with|by|on) (?:the |his |her |their )?(?:left|right)"
     r"(?: (?:leg|foot))?\b",
     " leading-foot "),
    (r"\ban? ((?:small |big |large |quick |slow |short |long |little |single |fast )?step)\b", r" one \1 "),
    (r"\b((?:(?:counter|anti)[- ]?)?clockwise) ((?:small |big |large |wide )?circles?)\b", r"\2 \1"),
    (r"\b(?:half|quarter|quater|semi|third|thirds|fourth|fourths)[- ]?(?:of )?(?:an? |the )?(?:in )?circles?\b",
     " semicircle "),
    (r"\b(?:in|on|along|around)(?: an?| the)?(?: [a-z-]+){0,2} circles?\b"
     r"|\ba (?:full |whole |complete |big |small )?circle\b",
     " in_circle "),
    (r"\b(?:figure|number)[ -](?:of )?(?:an? )?(?:8|eight)\b|\b\d+ ?degrees? of an? circle\b", " semicircle "),
    (r"\bto (?:the|his|her|one|their|its) side\b|\bside[- ]?steps?\b", " sideways "),
    (r"\b360 ?(?:degrees?|°)?|\bfull turn\b", " fullturn "),
    (r"\b(?:on|in) (?:the |one |a )?(?:same )?(?:spot|place)\b|\bin-place\b", " on_spot "),
    (r"\b180 ?(?:degrees?|°)|\bhalf turn\b|\babout[- ]face\b|\b(?:all the way )?around\b(?= *(?:$|[,.;]|and|then))",
     " around "),
    (r"\b90 ?(?:degrees?|°)", " quarterturn "),
    (r"\bhand stand\b", " handstand "),
    (r"\b(?:up|down|up and down) (?:the |some |a few )?steps\b", " stairs "),
    (r"\b(?:at the same time|simultaneously|meanwhile)\b", " at_once "),
    (r"\bfollowed by\b|\bafter (?:that|this|which)\b|\bafterwards?\b|\bsubsequently\b|\bafter a (?:while|moment)\b",
     " then "),
    (r"\b(?:finally|next|later|eventually|lastly)\b", " then "),
    (r"\bin front of\b", " near "),
    (r"\bas well(?: as)?\b|\balso\b|\btoo\b", " "),
    (r"\bhands? together\b", " hands "),
    (r"\bhands and knees\b|\ball fours\b", " allfours "),
    (r"\bon (?:one|his left|his right|the left|the right|her left|her right) (?:leg|foot)\b", " oneleg "),
    (r"\bright (after|before|then|now)\b", r" \1 "),
    (r"\ba (?:couple|pair) of (?:times|steps)\b", " 2 times "),
    (r"\b(?:several|many|a few|multiple|some|few) (times|steps|punches|squats|jumps|claps|sips)\b", r" 3 \1 "),
    (r"\bonce again\b|\bagain\b|\bonce more\b", " "),
    (r"\bone[- ]two\b", " "),
)  # fmt: skip

DIRECTIONS = {
    **dict.fromkeys(("left", "leftward", "leftwards"), "left"),
    **dict.fromkeys(("right", "rightward", "rightwards"), "right"),
    **dict.fromkeys(("towards", "toward", "approach", "closer", "nearer", "approaches", "approaching"), "towards"),
    **dict.fromkeys(("away", "retreat", "retreats", "retreating"), "away"),
    **dict.fromkeys(("forward", "forwards", "ahead", "straight", "onward", "advance", "advances"), "forwards"),
    **dict.fromkeys(("backward", "backwards", "back", "rear", "reverse"), "backwards"),
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
SEATS = _words(
    """
    sofa couch chair stool bed bench armchair seat ottoman settee recliner
    """
)
ARMS = _words(
    """
    hand hands arm arms fist fists palm palms wrist wrists
    """
)
RADAR = _words(
    """
    radar camera sensor me us viewer observer device photographer lens audience awr1843
    """
)
BOTH = _words(
    """
    both hands arms fists
    """
)
OWN = _words(
    """
    his her their its my your own
    """
)
PRONOUNS = _words(
    """
    he she it they i we you who someone somebody
    """
)

NEGATIONS = _words(
    """
    not never no without cannot cant dont doesnt didnt isnt wont wasnt nor neither instead except refuses refuse
    avoids hardly barely nobody none rather
    """
)
MANY = _words(
    """
    people persons men women boys girls children kids couple crowd humans users everyone family pair others group
    team subjects
    """
)
NOT_HUMAN = _words(
    """
    dog cat robot horse bird car animal monkey drone cow elephant fish pet puppy
    """
)
# Words that make it another movement than the one known, so that leaving them out would be wrong.
OTHER_MOVEMENT = _words(
    """
    stairs stair staircase stairway upstairs downstairs ladder ramp slope hill uphill downhill beam rail handrail
    railing rope trampoline treadmill bike bicycle ball like semicircle allfours oneleg sideways sidewards sideway
    laterally diagonally zigzag slalom curve curved arc bend obstacle hurdle over knees knee leg legs foot tiptoe
    tiptoes handstand cartwheel floor ground wheelchair swimming dance kick kicks flip somersault asleep drunken
    drunk limp crossed spiral triangle rectangle swings phone head shoulder shoulders elbow elbows hips hip thigh
    sit-ups push-ups lunge lunges plank violin guitar golf tennis racket upward downward platform edge curb log
    bridge bent hunched crouched bending kneeling circle circles circular fullturn quarterturn quarter against
    reacts push
    pushes perturbation balance trips stumbles shuffle scooter skateboard grapevine waltz
    """
)
# Words that may stand anywhere and change nothing that can be acted out.
FILLERS = _words(
    """
    a an the this that these there his her their its my your own one's is are was were be been being am has have
    had will would can could should may might shall and or with in on at to for from of by into onto over_to up
    down off out near next beside behind between through across along until till during so very really quite
    fairly rather just only then now still while bit little some any each every per all again together himself
    herself themselves itself myself person man woman human guy lady boy girl user subject child kid adult someone
    somebody he she it they i you who which figure individual participant patient gentleman male female actor
    player student tenant resident speaker character young old elderly tall short big small large long wide medium
    normal normally regular average casual casually comfortably comfortable relaxed happily happy sad sadly
    nervously angrily politely friendly confidently quietly silently steadily steady natural naturally simply
    repeatedly continuously constantly several few many multiple times time speed pace fashion manner way style
    motion movement movements moderate moderately usual usually side direction line room place position spot area
    middle centre center front end start beginning point distance wall window door table desk kitchen living
    office bedroom corridor hallway lab tv television plant shelf hello goodbye bye hi greeting friend attention
    audience help air high higher overhead above chest mouth lips water coffee tea juice beer wine milk soda cup
    glass mug bottle straw refreshing hot cold warm glass_of body upright straight_up feet deep deeply low fully
    halfway half full once more round rhythm rhythmically beat loudly loud enthusiastic excited excitedly proudly
    cheerfully joyfully smoothly bag combo combination hooks hook uppercut uppercuts jabs straight_punch opponent
    invisible imaginary shadow where when as because order what how here clearly visibly slightly somewhat lightly
    hard strongly strong firmly stationary motionless motionlessly immobile perfectly completely moment second
    seconds minute exercise exercises workout gym set sets repetitions reps fitness jacks steps pairs large-ish
    meters metres meter metre m cm width apart shirt jacket hat red blue black white green please kindly him them
    something anything first about whole complete successive consecutive row close someone's person's man's user's
    woman's arm's
    """
)
