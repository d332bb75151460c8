"""The lexicon: words that a sentence may contain, by their function."""

from mmweaver.motion.language.gesture_phrases import GESTURE_PHRASES
from mmweaver.motion.language.phrases import ACTIVITY_PHRASES
from mmweaver.motion.language.sided_phrases import SIDED_PHRASES
from mmweaver.motion.language.verbs import words_in

# These mean walking if the clause gives a destination.
GOING = frozenset({"go", "move", "head", "come", "return"})
# A word for a place to go to -> Landmark.kind.
TARGETS = {
    **{kind: kind for kind in ("door", "table", "window", "couch", "chair", "bed", "desk", "shelf", "counter", "wall",
                               "fridge", "tv", "wardrobe", "sink", "plant", "lamp", "stove", "cabinet")},
    **dict.fromkeys(("doorway", "exit", "entrance", "doors"), "door"),
    "sofa": "couch", "settee": "couch", "armchair": "chair",
    "stool": "chair", "bookshelf": "shelf", "bookcase": "shelf", "shelves": "shelf", "worktop": "counter",
    "countertop": "counter", "television": "tv", "refrigerator": "fridge", "closet": "wardrobe", "oven": "stove",
    "cupboard": "cabinet", "windows": "window",
}  # fmt: skip
# Light verbs: "does squats", "starts walking", "keeps waving".
LIGHT = words_in(
    """
    do perform make take give start begin continue keep proceed execute practice practise have throw land decide
    """
)
IRREGULAR = {
    "sat": "sit", "stood": "stand", "drank": "drink", "ran": "run", "strode": "stride",
    "went": "go", "gone": "go", "came": "come", "made": "make", "did": "do", "does": "do", "done": "do", "took": "take",
    "gave": "give", "began": "begin", "kept": "keep", "leapt": "leap", "threw": "throw", "goes": "go",
    "froze": "freeze", "fell": "fall", "ate": "eat", "wrote": "write", "lying": "lie", "knelt": "kneel",
    "laying": "lie", "shook": "shake", "bowed": "bow", "spun": "spin",
    "seated": "seated", "has": "have", "had": "have",
}  # fmt: skip
BASE_VERB_SPEED = {"stroll": -1, "amble": -1, "saunter": -1, "sprint": 1, "march": 0}

PHRASES: tuple[tuple[str, str], ...] = (  # replaced in this order before anything is looked up
    (r"\bfor (?:a|quite a) (?:little |short |long )?while\b", " "),
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
    (r"(?<!the )(?<!his )(?<!her )(?<!its )\bright (after|before|now)\b", r" \1 "),
    (r"\ba (?:couple|pair) of (times|steps)\b", r" 2 \1 "),
    (r"\b(?:several|many|a few|multiple|some|few) "
     r"((?:(?:more |other |small |large |big |little |short |long |quick |slow )*(?:[a-z]+ )?)??)"
     r"(times|steps|punches|squats|jumps|claps|sips|kicks|hops|strides|bows|lunges)\b", r" 3 \1\2 "),
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
SEATS = words_in(
    """
    sofa couch chair stool bed bench armchair seat ottoman settee recliner
    """
)
ARMS = words_in(
    """
    hand hands arm arms fist fists palm palms wrist wrists
    """
)
RADAR = words_in(
    """
    radar camera sensor me us viewer observer device photographer lens audience awr1843
    """
)
BOTH = words_in(
    """
    both hands arms fists
    """
)
OWN = words_in(
    """
    his her their its my your own
    """
)
PRONOUNS = words_in(
    """
    he she it they i we you who someone somebody
    """
)

NEGATIONS = words_in(
    """
    not never no without cannot cant dont doesnt didnt isnt wont wasnt nor neither instead except refuses refuse
    avoid avoids avoiding hardly barely nobody none rather
    """
)
MANY = words_in(
    """
    people persons men women boys girls children kids couple crowd humans users everyone family pair others group
    team subjects
    """
)
NOT_HUMAN = words_in(
    """
    dog cat robot horse bird car animal monkey drone cow elephant fish pet puppy
    """
)
# Words that make the movement another one, so that ignoring them would be wrong.
OTHER_MOVEMENT = words_in(
    """
    rolling-over figure-eight wheel wheels gap ontop stoop sway podest curves sticks shuffles touchdown mirrored
    square ellipse oval loop loops number torso trunk defense defence guard defensive gymnastics gymnastic angle
    s-shape s-curve slalom eight break breakdance breakdancing mid-air midair stairs stair staircase
    stairway upstairs downstairs ladder ramp slope hill uphill downhill beam rail handrail railing trampoline
    treadmill bike bicycle like allfours diagonally zigzag obstacle hurdle over knees knee leg legs foot tiptoe
    tiptoes handstand cartwheel floor ground wheelchair swimming flip somersault asleep crossed spiral triangle
    rectangle swings head shoulder shoulders elbow elbows hips hip thigh sit-ups push-ups plank tennis racket
    upward downward platform edge curb log bridge bent hunched crouched against reacts shuffle scooter skateboard
    grapevine waltz circle circles tango salsa waltzing ballet backflip kata karate fight fighting drums drum
    piano trumpet flute conductor conducts skiing skating surfing climbing climbs climb vault vaults
    dog partner someone_else sits_up leap-frog zombie stork sneaks sneaking sneak injured drags dragging
    half-circle guitar violin golf tightrope toes heel heels heel-toe obstacles hole puddle stones steps_up
    side_flip headstand diagonal yoga basketball baskeball football soccer volleyball juggles kickboxing air-plane
    scared
    """
)
# Words that may be ignored: they change nothing that can be acted out.
FILLERS = words_in(
    """
    a an the this that these there his her their its my your own one's is are was were be been being am has have
    had will would can could should may might shall and or with in on at to for from of by into onto over_to up
    down off out near next beside behind between through across along until till during so very really quite
    fairly rather just only then now still while bit little some any each every per all again together himself
    herself themselves itself myself person man woman human guy lady boy girl user subject child kid adult
    someone somebody he she it they i you who which figure individual participant patient gentleman male female
    actor player student tenant resident speaker character young old elderly tall short big small large long
    wide medium narrow humans normal normally regular average casual casually comfortably comfortable relaxed
    quietly silently steadily steady natural naturally simply repeatedly continuously constantly several few
    many multiple times time speed pace fashion manner way style motion movement movements moderate moderately
    usual usually side direction line room place position spot area middle centre center front end start
    beginning point distance wall window door table desk kitchen living office bedroom corridor hallway lab tv
    television plant shelf hello goodbye bye hi greeting friend attention audience help air high higher overhead
    above chest mouth lips water coffee tea juice beer wine milk soda cup glass mug bottle straw refreshing hot
    cold warm glass_of body upright straight_up feet deep deeply low fully halfway half full once more round
    rhythm beat smoothly bag combo combination hooks hook uppercut uppercuts jabs straight_punch opponent
    invisible imaginary shadow where when as because order what how here clearly visibly slightly somewhat
    lightly stationary motionless motionlessly immobile perfectly completely moment second seconds minute minutes
    exercise exercises workout gym set repetitions reps fitness jacks steps pairs large-ish meters metres
    meter metre m cm width apart shirt jacket hat red blue black white green please kindly him them something
    anything first about whole complete successive consecutive row close someone's person's man's user's woman's
    arm's drunk drunken tight careful recovery starting ending performing doing object thing things ball box
    book soup pot surface board plate food meal dish bowl handle screen keyboard computer laptop cloth
    whiteboard blackboard letter note pen apple sandwich breakfast lunch dinner rope cart plane objects waist breast
    breast-high chest-high hair teeth sink mirror newspaper magazine mail email towards_it it's reading_glasses
    tempo pose posture stance kind sort type_of lot music song hall quick-ish normal-speed relatively tiny huge
    bigger larger smaller greater instrument virtual fridge cupboard lamp shoes toilet bath shower bathroom
    garden street path track route trajectory consecutively successively subsequently than meanwhile both-handed
    right-handed right-hand floor ground sides aside suddenly sudden past toward beneath
    """
)
# How something is done, in ways that no movement of the library shows: known, and said to be left out.
MANNERS = words_in(
    """
    happily happy sad sadly nervously angrily politely friendly confidently proudly cheerfully joyfully excited
    excitedly enthusiastic loudly loud hard strongly strong firmly awkward rough sharp rhythmically joyful
    cheerful furiously anxiously anxious nervous angry calm bored boredly tired tiredly exhausted elegantly
    gracefully clumsily clumsy stiffly stiff aggressively aggressive dramatically wildly hesitantly tentatively
    playfully sternly forcefully powerfully heavily
    """
)
# Sizes of a movement.
SIZES = words_in(
    """
    big large small little tiny huge long short wide narrow high deep low bigger larger smaller greater giant
    mini exaggerated tight
    """
)
# Before a place that a walk passes or goes to.
PASSED = words_in(
    """
    to towards toward between through across along behind past into onto around under beneath out from beside
    """
)
# Verbs with which "step" or "steps" is a noun.
STEPPING = GOING | words_in(
    """
    walk jog run jump hop turn advance march retreat sidestep stumble pushed dance tumble stagger limp crawl
    """
)
# Units of distance.
DISTANCES = words_in(
    """
    meters metres meter metre m cm centimeters feet yards
    """
)
# Verbs with which a leg, knee or foot is no other movement.
LEG_VERBS = words_in(
    """
    kick raise lift stomp stamp one_leg_stand hop jump leap turn pivot rotate spin kneel_down kneel lunge limp
    hobble step walk
    """
)
# Verbs with which the floor is no other movement.
FLOOR_VERBS = words_in(
    """
    lie lay lie_down fall collapse topple pick_up put_down get_up stand_up kneel kneel_down kneel_up stomp
    stamp look_around bend faint wipe clean point
    """
)
# Words for an object, which a person who "moves" one does not act out.
THINGS = words_in(
    """
    object objects something thing things box it them
    """
)
# Words that belong to the noun or verb after them.
BEFORE_NOUNS = words_in(
    """
    a an one small big quick fast slow sharp short full is gets sideways little slight further
    """
)
# Nouns and adjectives that look like forms of a verb.
NOUNS_LIKE_VERBS = words_in(
    """
    ceiling evening morning bed red building wing king tired something anything everything during
    """
)
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
