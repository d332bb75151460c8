"""Movements that are shown as similar ones: tried where a sentence is not understood, and said as approximated.

A replacement has the same part of the body move in a similar way. An empty one stands for something that moves
nothing a radar sees.
"""

import re
from dataclasses import dataclass
from functools import cache

from mmweaver.motion.language.limb_approximations import INSTEAD_OF_ANOTHER, WHERE_UNKNOWN

_OWN = r"(?:(?:his|her|its|their|the|both|a|an|some|one|my|own) )*"
_SIDE = r"(?:left|right)"
MARK = "approx_"


@dataclass(frozen=True)
class Approximation:
    """A pattern of the sentence, the words that are acted out instead, and how that is said."""

    pattern: str
    instead: str
    how: str
    always: bool = False  # also where the sentence would be understood, but as something else
    in_part: bool = False  # only where a sentence may be read in part


def _verb(stem: str, end: str = "") -> str:
    """All forms of a verb given by its stem: 'ir' + 'on' as 'iron'."""
    return rf"\b{stem}(?:e?s|ing|ed|e)?\b{end}"


_THING = r"(?: +(?!and\b|then\b|while\b|with\b|before\b|after\b|,)[a-z'-]+){0,4}"
_AS = "is shown as"

_NOT_DONE = (  # where something else is done
    r"(?<=[a-z]),? without [a-z]+ing\b[^,.;]*?(?=$|[,.;]| and\b| then\b)|,? so (?:that )?(?:no ?one|nobody) [^,.;]*"
    r"|(?<=[a-z]),? but (?:does|do|did|is|was)(?: not|n't) [^,.;]*?(?=$|[,.;]| and\b| then\b)"
)

APPROXIMATIONS: tuple[Approximation, ...] = (
    *(Approximation(*row, always=True) for row in INSTEAD_OF_ANOTHER),
    *(Approximation(pattern, instead, how, always=True) for pattern, instead, how in (
        (r"\b(?:turn|switch)(?:s|es|ing|ed)? (?:on|off) (?:the |a |his |her )?(?:[a-z]+ )?(?:light|lights|lamp|tv|television|radio|stove|computer|music|heating|fan)\b"
         r"|\b(?:turn|switch)(?:s|es|ing|ed)? (?:the |a )?(?:light|lights|lamp|tv|radio|stove|computer) (?:on|off)\b",
         "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\bbounc(?:es|ing) (?:a|the) (?:[a-z]+ )?ball\b|\bdribbl(?:es|ing)\b(?: (?:a|the) [a-z]+)?", "knocks", "is shown as a hand beating"),
        (r"\bmov(?:es|ing) (?:a|an|the|some) (?:heavy |big |small )?(?:chair|table|sofa|couch|bed|desk|box|boxes|furniture|stool|objects?)\b(?: around| aside)?",
         "pushes something", f"{_AS} pushing it"),
        (r"\b(?:turn|flip)(?:s|ing)? (?:the )?pages?\b", "reads", f"{_AS} reading"),
        (r"\b((?:walk|go|run|jog|step|stand|sit|jump|stagger)(?:s|es|ing|ning|ting|ping)?\b[^.;]*?),? as (?:if|though) (?:he|she|it|they|the person) (?:is|was|were|had|has|would) (?!(?:being |been )?(?:play|carry|drunk|hold|push|shov|hit))[^.;]*?(?=$|[.;]|, )",
         r"\1", "what it looks like is not shown"),
        (r"\b(?:is |are |gets? |got |getting |being |been |has been )+(?:kicked|struck|knocked|thrown|tackled)\b(?: over| back)?", "is pushed", "what hits the person is not shown"),
        (rf"\b(l(?:ies|ying|ays|aying)) (?:down )?on {_OWN}(?:{_SIDE} )?side\b", r"\1 on the back", "lying on a side is shown as lying on the back"),
        (r"(?:,? (?:and|then|before|but))* ?(?:carefully |slowly )?(?:returns?|returning|gets? back|goes back|going back|comes back|finds? (?:it|his|her) way back|continues|moves back) (?:back )?(?:in|on|to|onto|into) (?:(?:the|his|her|its) )?(?:(?:previous|original|initial|old|former|intended) )?(?:path|track|trajectory|line|course|way|direction)\b(?= *(?:$|[.,]|and|then))",
         "", "the way back to the path is not shown"),
        (rf"\b(?:touch|grasp|grabb?|grip|hold|scratch|strok)(?:es|s|ing) (?:with {_OWN}({_SIDE}) (?:hand|arm) )?(?:at |to |on )?(?:(?:the )?(?:back|top|side) of )?(?:(?:his|her|its|their|the) )?(?:left |right )?(?:head|hair|neck|ear|forehead)\b(?: with {_OWN}({_SIDE} )?(?:hand|arm))?",
         r"combs the hair with the \1\2 hand", "a hand at the head is shown as combing"),
        (rf"\b(?:wip(?:es|ing)|rub(?:s|bing)?|wash(?:es|ing)?) {_OWN}(?:face|nose|mouth|eyes?|forehead|cheeks?|brow|sweat)\b(?: (?:off|from) [a-z ]+?)?(?: with {_OWN}({_SIDE} )?(?:hand|arm|sleeve))?(?=$|[ ,.])", r"brushes the teeth with the \1 hand", "a hand at the face is shown as brushing teeth"),
        (r"\b((?:throws?|throwing|does|with|and) )(?:an? )?((?:left |right )?)(?:cross|hook)\b(?= with|$|,| and)", r"\1 \2punch", "the kind of punch is not distinguished"),
        (rf"\b(?:stretch|put|mov|tak|hold|reach)(?:s|es|ing|ting)? (?:out )?{_OWN}({_SIDE} )?(?:hands?|arms?) (?:to|behind|on|at) {_OWN}back\b", "stands", "a hand at the back is not shown"),
        (r"\b((?:sits?|sitting|seated|lies|lying)\b[^.;]*?),?(?: and| then|,)+ (?:falls? asleep|sleeps?|naps?|snoozes|dozes(?: off)?)\b", r"\1", "sleep is shown as keeping still"),
        (r"\b((?:walk|run|jog|go|stroll|limp|stagger)(?:s|es|ing|ning)?) ((?:slowly |quickly )?)(?:a?round|about) (?:the|a|an|his|her|their) (?:[a-z]+ )?(table|sofa|couch|chair|desk|bed|stool|furniture|plant|lamp)s?\b",
         r"\1 \2around the room", "the way around it is shown as walking to and fro"),
        (r"\bswim(?:s|ming)?(?: (?:in |with )?(?:the |a )?(?:front )?(?:crawl|backstroke|breast-?stroke|butterfly)(?: style)?)?\b", "circles the arms", f"{_AS} circling the arms, standing"),
        (rf"\btouch(?:es|ing) (?:the )?(?:floor|ground)(?: with {_OWN}(?:{_SIDE} )?(?:hands?|fingers?))?", "picks something up from the floor", "touching the floor is shown as picking something up from it"),
        (r"\bas (?:if|though) (?:(?:he|she|it|they) (?:is |was |were )?)?being (?!(?:push|shov|hit|drunk))[a-z]+ed\b", "", "what it looks like is not shown"),
        (r"\b(?:with an? )?(?:(?:little|short|small) )?(?:break|pause) after (?:the )?(?:step \d+|(?:first|second|third) step)\b", "", "the pause is not shown"),
        (r"\b(?:performs?|makes?|does|doing|performing) (?:an? )?(?:front )?crawl(?:ing)? (?:movement|motion|stroke)s?\b(?: with (?:his|her|its|the|both) (?:arms|hands))?", "circles the arms", f"{_AS} circling the arms"),
        (rf"\bbounc(?:es|ing) {_OWN}({_SIDE} )?(hands?|arms?)(?: up and down)?", r"knocks with the \1 \2", f"{_AS} a hand beating"),
        (r"\b(?:evad|dodg|avoid|sidestepp?)(?:es|s|ing) (?:it|him|her|them|(?:an? |the |some )?(?:obstacle|object|person|ball)s?)\b(?! to (?:the|its|his))", "sidesteps", f"{_AS} a step aside"),
        (r"\b(?:dodg|evad|avoid|duck|block|parr)(?:es|s|ing|ies|ying) (?:an? |the |some )?(?:[a-z]+ )?(?:punch|hit|blow|attack|kick|strike)(?:es|s)?\b(?: in a (?:box )?fight)?(?: by leaning)?",
         "crouches ", f"{_AS} crouching"),
        (rf"\bbend(?:s|ing) {_OWN}knees?\b(?: slightly| a (?:little )?bit| deeply)?|\bknee[- ]bend(?:s|ing)?\b", "squats", "bent knees are shown as a squat"),
        (rf"\b(?:rotat|swirl|circl|roll|spin)(?:e?s|ing) (?:them\b|{_OWN}(?:{_SIDE} )?(?:arms?|shoulders)\b)(?: (?:a?round|in circles|forwards?|backwards?))*", "circles the arms", f"{_AS} circling the arms"),
        (rf"\b(?:rotat|swirl|circl|roll|spin|turn)(?:e?s|ing) {_OWN}({_SIDE} )?(?:hands?|wrists?|forearms?)\b(?: (?:a?round|in circles))*", r"stirs the soup with the \1 hand", "a turning hand is shown as stirring"),
        (rf"\btap(?:s|ping) {_OWN}({_SIDE} )?(?:foot|feet|toes|heels?)\b(?: on the (?:floor|ground))?", r"stamps with the \1 foot", "a tapping foot is shown as stamping"),
        (rf"\bswing(?:s|ing) {_OWN}({_SIDE} )?leg\b(?: (?:back and forth|forwards? and backwards?|around|in circles?|out|forwards?))*", r"raises the \1 leg", "a swinging leg is shown as a leg that is raised"),
        (rf"\b(?:put|plac|set)(?:s|es|ting|ing) (?:it|them) (?:back(?! down| to)|on|onto|in|into) (?!(?:the )?(?:floor|ground)\b)(?:{_OWN}[a-z]+(?: side)?)?(?=$|[ ,.])", "reaches for something", "is shown as reaching out with a hand"),
        (r"\b(fall|slip|tumble)(?:s|ing)? (?:forwards?|backwards?|over) (?:off|from|out of) (?:the |a |an |his |her |their )?(chair|stool|sofa|couch|bed|bench|seat|armchair)", r"\1s off the \2", "falling off a seat is shown as falling to its side"),
        (rf"(?:,? (?:with|holding|keeping))? {_OWN}({_SIDE} )?(?:hands?|arms?) (?:folded |clasped |held |crossed )?(?:behind|on|at) (?:his|her|its|their|the) backs?\b", "", "hands behind the back are not shown"),
        (r"\bskip(?:s|ping|ped)? (?=forward|ahead|along|to|away|back)", "jumps ", "skipping is shown as jumping"),
        (r"\b(?:did|does|do|performs?|makes?) (?:an? )?(?:kick[- ]spin|spin(?:ning)?[- ]kick|roundhouse(?:[- ]kick)?|tornado kick)\b", "kicks, then turns 360 degrees", "kick and turn are shown one after the other"),
        (rf"\bmov(?:es|ing) (?:his or her |{_OWN})({_SIDE} )?(?:hands?|arms?)(?: [a-z]+){{0,7}}? (?:in )?(?:an? |the form of an? )?(?:[a-z-]+ )?circles?\b", r"stirs the soup with the \1 hand", "a circling hand is shown as stirring"),
    )),
    *(Approximation(pattern, instead, how) for pattern, instead, how in (
        (rf"\b(?:performs?|performing|makes?|making|doing|does|draws?) (?:an? |some )?(?:circling|circular|rotating|turning|round|circle) (?:motion|movement|gesture)s? (?:with|using) {_OWN}({_SIDE} )?(?:hands?|arms?)\b",
         r"stirs the soup with the \1 hand", "circling hands are shown as stirring"),
        (r"\b(?:jump|leap|hop)(?:s|ing|ping|ed|ped)? (?:up )?over (?!(?:the |an? )?(?:chair|table|sofa|bed)\b)(?:an? |the |some |it\b|something\b)?(?:[a-z]+(?= *(?:$|[,.;]| and| then)))?(?:[a-z]+ [a-z]+(?= *(?:$|[,.;]| and| then)))?",
         "jumps forwards", "is shown as a jump forwards; what is jumped over is not shown"),
        (r"\b(?:interact|work|play|fiddl|operat|manipulat|handl)(?:s|es|ing) (?:with |on |at )?(?:an? |some |the )?(?:[a-z]+ )?(?:something|objects?|things?|device|machine)\b", "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\b(?:makes?|does|doing|performs?|performing|turns?|dances?) (?:an? |some |two )?(?:[a-z]+ )?(?:pirouettes?|twirls?)\b|\b(?:pirouettes|pirouetting|twirls|twirling)\b", "turns 360 degrees", "is shown as a turn"),
        (r"\b(?:sits?|sitting)(?: down)? on (?:the |an? )?(?:floor|ground)\b|\bsits? down cross-?legged\b", "kneels down", "sitting on the floor is shown as kneeling"),
        (r"\b(?:go|walk|run|climb|jump|step|come|mov)(?:s|es|e|ing|ning|ping)? (?:up and down|up|down)(?: (?:the|some|a few|two|three|four|five))? steps\b", "step_up_and_down", "stairs are shown as stepping up and down on the spot"),
        (r"(?:,? (?:and|then))* ?\brepeats?(?:ing)?(?: (?:it|this|that|everything|the (?:whole )?(?:process|motion|movement|exercise)))?(?: (?:again|once|twice|(?:two|three|four|several|multiple) times))?(?=$|[.,])", "", "the repetition is not shown"),
        (r"\b(?:then )?something happens(?: and)?\b", "", "what happens is not shown"),
        (r"\b(?:while |and )?look(?:s|ing)? (?:up|upwards?|after|under)(?: (?:at |to |in |into )?(?:it|the (?:sky|ceiling|air)))?(?=$|[,.]| and\b)", "", "a look is not shown"),
        (r"\bpat(?:s|ting)\b", "knocks", f"{_AS} a hand beating"),
        (r"\b(?:performs?|does|makes) (?:an? )?(?:slap|smack)\b|\bslap(?:s|ping)\b" + _THING, "punches", f"{_AS} punching"),
        (r"\b(?:shoots?|shooting) (?:an? |the )?(?:foot|soccer )?ball\b", "kicks a ball", f"{_AS} kicking a ball"),
        (rf"\b(?:hik|lift|rais)(?:es|s|ing) {_OWN}shoulders\b", "shrugs", f"{_AS} shrugging"),
        (r"\b(?:is|being|gets) drunk\b", "staggers", f"{_AS} staggering"),
        (rf"\b(?:moves?|swings?|sways?|shakes?|wiggles?) (?:with )?{_OWN}(?:hips?|upper body|body|torso|whole body)\b(?: (?:left and right|from side to side|back and forth|around))?", "dances", f"{_AS} dancing"),
        (r"(?:,? and|,)? (?:then )?ends? (?:up )?(?:on |in |at |right )*(?:the |his |its |her )?(?:same )?(?:spot|start\w*|origin\w*|position|place|where)[a-z ]*(?=$|[.,])", "", "where it ends is not kept"),
        (r"\b(?:goes|going|gets?|getting) (?:down )?(?:on|onto|to|an) (?:the (?:floor|ground) )?(?:on )?all[- ]fours?\b", "kneels down", "all fours are shown as kneeling"),
        (rf"\b(?:performs?|performing|does|doing|makes?|making) (?:an? |the |some )*(?:actions?|activit(?:y|ies)|something|(?:complicated |complex )?sequences?|tasks?) (?:with|using|by) {_OWN}(?:two |both |({_SIDE}) )?hands?\b", "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\b(?:gets?|getting|becomes?|becoming) (?:a bit |much )?(?:slower|faster|quicker)\b(?: and (?:slower|faster))?", "", "a change of speed is not shown"),
        (r"\b(?:mov|go|walk|run|com|jog|step)(?:es|s|ing|ning)? (?:slowly |quickly )?(?:up|down) (?:an? |the )?(?:[a-z]+ )?(?:ramp|slope|hill|incline|hillside|mountain)s?\b", "walks", "the slope is not shown"),
        (rf"\bdraw(?:s|ing) (?:an? |two |three |some )?(?:[a-z]+ )?(?:lines?|circles?|shapes?|rectangles?|squares?) (?:in|into)?(?: the)? ?(?:air|front of (?:him|her|it|them))?,? ?(?:with|using) (?:both|the|his|her) {_OWN}(?:{_SIDE} )?hands?\b", "writes on a board", "drawing in the air is shown as writing"),
        (r"\b(?:hit|stroke|swing|shot|putt)s? (?:of (?:a|the) ball )?(?:with|using) (?:an? |the )?(?:mini?-?)?golf[- ]?club\b", "plays golf", "is shown as a golf swing"),
        # exercises and sports
        (r"\bshift(?:s|ing) (?:his |her |its |their |the )?(?:body )?weight\b(?: from (?:the )?(?:left|right|one)(?: (?:foot|leg|side))? to (?:the )?(?:left|right|other)(?: (?:foot|leg|side))?)?", "leans from side to side", "a shift of weight is shown as leaning"),
        (r"\b(?:does|doing|makes|performs) (?:an? |some )?twist(?:ing|s)?(?: (?:motion|movement)s?)?\b", "twists the upper body", f"{_AS} twisting the trunk"),
        (r"\b(?:gets?|got|getting) down\b(?! (?:on|to|onto|from))", "kneels down", f"{_AS} kneeling down"),
        (r"\b(?:(?:do|perform|mak)(?:es|s|ing|e)? )?high[- ]knees\b", "marches on the spot quickly", "high knees are shown as marching quickly"),
        (r"\b(?:(?:do|perform)(?:es|s|ing)? )?(?:mountain climbers?)\b", "holds a plank", f"{_AS} a plank"),
        (r"\b(?:(?:do|perform)(?:es|s|ing)? )?(?:lateral|side) raises?\b", "stretches both arms out to the sides", f"{_AS} arms held out"),
        (r"\b(?:(?:do|perform)(?:es|s|ing)? )?(?:an? )?(?:bicep|biceps|arm|hammer|dumbbell)s? curls?\b|\bcurls? (?:a |the )?(?:dumbbells?|weights?|barbell)\b", "raises both hands from the elbow", "a curl is shown as raised forearms"),
        (r"\b(?:(?:do|perform)(?:es|s|ing)? )?(?:overhead|shoulder|military) press(?:es)?\b", "raises both arms", f"{_AS} raised arms"),
        (r"\b(?:(?:do|perform|mak)(?:es|s|ing)? )?arm swings?\b", "circles the arms", f"{_AS} circling the arms"),
        (r"\b(?:shoot|serv|spik|dunk|pitch|bowl|bat|hit|smash|shot)(?:s|es|ing|ting|ts)? (?:an? |the )?(?:[a-z]+ )?(?:ball|basketball|volleyball|baseball|football|puck|frisbee|dart)\b(?! with (?:an? |the )?(?:golf|club|racket|bat))|\b(?:(?:do|mak|shoot|perform|tak)(?:es|s|ing)? )?(?:an? |the )?(?:basketball )?(?:lay-?up|free throw|jump shot|three[- ]pointer|slam dunk|dunk)\b",
         "throws a ball", f"{_AS} throwing a ball"),
        (r"\bmoon-?walk(?:s|ing)?\b", "walks backwards", f"{_AS} walking backwards"),
        (rf"\bfan(?:s|ning) (?:himself|herself|themselves|itself|{_OWN}face)\b", "waves", "fanning is shown as waving"),
        (r"\bfollow(?:s|ing) (?:an?other|an?|the|some|his|her|their) ?[a-z]*\b", "walks", f"{_AS} walking"),
        (rf"\bdraw(?:s|ing) (?:an? |the )?(?:[a-z]+ )?(?:x|tick|cross|check ?mark|triangle|square|star|heart|letter|number|shape|line)s?\b(?: in the air)?(?: with {_OWN}({_SIDE} )?(?:hand|arm|finger))?", r"writes on a board with the \1 hand", "drawing in the air is shown as writing"),
        (r"\b(?:push|pull)(?:es|s|ing) (?:an? |the |his |her )?(?:[a-z]+ )?(?:cart|trolley|stroller|pram|wheelchair|lawn ?mower|wheelbarrow|sledge|suitcase)\b(?! over)", "pushes something", "the thing that is pushed or pulled is not shown, nor where it goes"),
        (r"\btouch(?:es|ing) (?:his |her |its |their |the )*(?:toes|feet|ankles|shins)\b", "bends down", f"{_AS} bending down"),
        # at home
        (r"\b(?:iron(?:s|ing)?|polish(?:es|ing)?|dust(?:s|ing)?|paint(?:s|ing)?|sand(?:s|ing)?|rub(?:s|bing)? (?!(?:his|her|the|their|two|both) ?hands))"
         rf"{_THING}", "wipes", f"{_AS} wiping"),
        (r"\b(?:wash|rins|dri|scrub|soap)(?:es|ing|s|bing)? (?:up )?(?:the |some )?(?:dishes|plates?|cups?|windows?|car|floor|table)\b",
         "wipes", f"{_AS} wiping"),
        (r"\b(?:does|doing) the (?:dishes|washing[- ]up|cleaning|housework)\b", "wipes", f"{_AS} wiping"),
        (r"\b(?:wash(?:es|ing)?|rub(?:s|bing)?|dr(?:ies|ying)|soap(?:s|ing)?|applies cream on|creams?) (?:his |her |the |their |its |two |both )*hands(?: together)?\b",
         "claps", "hands rubbed against each other are shown as clapping"),
        (rf"\b(?:wip(?:es?|ing)|wash(?:es|ing)?) {_OWN}(?:face|nose|cheeks?|mouth|beard)\b"
         r"|\b(?:shav(?:es?|ing)|powder(?:s|ing)?|(?:applies|applying|puts on|putting on) (?:cream|makeup|lotion)(?: on)?)"
         rf"(?: {_OWN}(?:face|nose|cheeks?|mouth|beard))?(?=$|[ ,.])(?: in front of the mirror)?",
         "brushes the teeth", "a hand at the face is shown as brushing teeth"),
        (rf"\b(?:blow(?:s|ing)?|clean(?:s|ing)?) {_OWN}nose\b", "brushes the teeth", "a hand at the face is shown as brushing teeth"),
        (rf"\b(?:wash(?:es|ing)?|scratch(?:es|ing)?|touch(?:es|ing)?|flicks?|strok(?:es|ing)) {_OWN}(?:hair|head|neck)\b(?: because of [a-z ]+)?",
         "combs the hair", "a hand at the head is shown as combing"),
        (r"\b(?:(?:performs?|performing|does|makes) (?:an? |some )?)?wash(?:es|ing)?\b(?: (?:movement|motion)s?)?(?! (?:up|the dishes))" + _THING, "wipes", f"{_AS} wiping"),
        (rf"\b(?:puts?|putting|tak(?:es|ing)|adjusts?|lifts?) (?:on|off) {_OWN}(?:glasses|sunglasses|hat|cap|headphones|helmet|earphones|mask)\b",
         "combs the hair", "hands at the head are shown as combing"),
        (r"\b(?:cook|bak|mix|knead|fry)(?:s|es|ing)?\b" + _THING + r"|\bprepar(?:es|ing) (?:the |a |some )?(?:food|dinner|lunch|breakfast|meal|tea|coffee)\b", "stirs the soup", f"{_AS} stirring"),
        (r"\b(?:chop|cut|slic|peel|saw|grat)(?:s|es|ing|ping|ting)?\b(?! (?:across|through))" + _THING, "stirs the soup",
         "is shown as stirring, a hand to and fro in front of the body"),
        (r"\b(?:water|pour)(?:s|ing)? " + _OWN + _THING, "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\b(?:set|lay|clear)(?:s|ting|ing)? the table\b", "reaches for something twice", f"{_AS} reaching out with a hand"),
        (r"\b(?:press|push)(?:es|ing)? (?:a |an |some |the )?(?:[a-z]+ )?(?:buttons?|switch|key|bell)\b", "reaches for something",
         f"{_AS} reaching out with a hand"),
        (r"\b(?:turn|switch)(?:s|es|ing)? (?:on|off) (?:the |a )?(?:light|lamp|tv|television|radio|stove|computer)s?\b"
         r"|\b(?:turn|switch)(?:s|es|ing)? the (?:light|lamp|tv|radio|stove) (?:on|off)\b",
         "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\b(?:hang|fold|unfold|stack|sort|arrang|pack|unpack|collect|tear|wrap|open|clos|shut|screw|plug|feed|touch|light)(?:s|es|ing|ting)?"
         r"(?: up| out| down)? (?!(?:his|her|its|their|the|both) (?:arms?|hands?|eyes|legs?)\b|(?:the |a )?(?:[a-z]+ )?door)"
         rf"{_OWN}[a-z]+{_THING}", "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\b(?:does|doing) (?:the |some )?laundry\b", "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\bclos(?:es?|ing) (?:the |a )?(?:[a-z]+ )?(?:door|fridge|cupboard|window|drawer|curtains?|blinds)\b", "opens the door", f"{_AS} opening it"),
        (r"\b(?:knit|sew|typ|play(?:s|ing)? (?:with )?(?:the |a |some )?(?:piano|keyboard|video games?|computer games?|cards|games?|magic cube)|"
         r"count(?:s|ing)? money)(?:s|ing|ting)?\b" + r"(?: on)?(?: the)?(?= sofa|$|[ ,.])", "types", f"{_AS} typing, small movements of both hands"),
        (r"\b(?:draw|paint|sketch|sign)(?:s|ing)? (?:an? |the |some )?(?:imaginary )?(?:horizontal |vertical )?(?:lines?|picture|something|shapes?)"
         r"(?: in the air)?\b", "writes on a board", f"{_AS} writing"),
        (r"\b(?:hammer|drum|nail|tap|rap)(?:s|ming|ping|ing)?\b(?! (?:his|her|its) (?:left|right))" + _THING, "knocks", f"{_AS} knocking"),
        (r"\bplay(?:s|ing)? (?:the |on the |some )?drums?\b", "knocks with both hands", f"{_AS} knocking"),
        (r"\bplay(?:s|ing)? (?:the |a )?(?:flute|trumpet|clarinet|saxophone|harmonica)\b", "phones", "hands at the mouth are shown as phoning"),
        (r"\bplay(?:s|ing)? (?:the |a )?(?:cello|harp|banjo|lute)\b", "plays the guitar", f"{_AS} playing the guitar"),
        (r"\b(?:tak(?:es|ing)) (?:an? |some |the )?(?:photos?|pictures?|selfies?)(?: of [a-z ]+)?(?: with (?:a|his|her|the) (?:phone|camera))?\b",
         "looks at the phone", f"{_AS} using a phone"),
        (r"\b(?:check|look)(?:s|ing)? (?:at |on )?(?:the time(?: on)?|his watch|her watch|(?:a|the|his|her) (?:watch|wrist))(?: (?:a|the|his|her) watch)?\b",
         "looks at the phone", "a look at the wrist is shown as one at a phone"),
        # gestures
        (r"\b(?:shak(?:es?|ing)) hands?\b(?: with [a-z ]+)?|\bhandshake\b", "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\bgiv(?:es|ing) (?:an? |the )?thumbs? (?:up|down)\b|\b(?:makes|making|shows|showing) (?:an? |the )?(?:ok|victory|peace|stop)[- ]?(?:sign|gesture)?\b",
         "points ahead", f"{_AS} pointing"),
        (r"\bbeckon(?:s|ing)?\b|\bgestur(?:es|ing)\b|\bgesticulat(?:es|ing)\b|\b(?:performs? |does |makes )?swip(?:es|ing)\b(?: (?:gestures?|motions?|movements?|left and right|something))?|\bfans? (?:himself|herself|itself)\b|\bflutters?(?:ing)?\b|\bwiggles?\b",
         "waves", f"{_AS} waving"),
        (r"\bsalut(?:es|ing)\b|\b(?:blow(?:s|ing)? (?:a )?kiss(?:es)?)\b|\bhush(?:es|ing)\b", "raises the right hand", f"{_AS} a raised hand"),
        (r"\b(?:cheers?|cheering)(?: up)?\b|\bcelebrates?\b", "raises both hands", f"{_AS} raising both hands"),
        (r"\b(?:beg|pray)(?:s|ging|ing)?\b|\b(?:puts?|putting) (?:the |his |her )?palms together\b|\bfolds? (?:the |his |her )?hands\b",
         "claps once", "hands put together are shown as a clap"),
        (r"\bhug(?:s|ging)?\b" + _THING + r"|\bembrac(?:es|ing)\b" + _THING, "stretches both arms forwards", f"{_AS} arms held out"),
        (r"\b(?:(?:do|mak|perform)(?:es|s|ing)? an? (?:[a-z]+ )?)?curt(?:s|se)(?:ies|ys?|eys?)\b", "squats once", f"{_AS} a squat"),
        (rf"\b(?:cover(?:s|ing)?|hid(?:es|ing)) {_OWN}(?:face|eyes|ears)(?: with (?:both|his|her) hands)?\b", "phones",
         "hands at the head are shown as phoning"),
        (rf"\b(?:hold(?:s|ing)?|clutch(?:es|ing)?|touch(?:es|ing)?|scratch(?:es|ed|ing)?|rub(?:s|bed|bing)?|massag(?:es|ing)) {_OWN}(?:{_SIDE} )?(?:chest|heart|stomach|belly|shoulder)\b(?: in pain| because of [a-z]+)?(?: with {_OWN}(?:{_SIDE} )?(?:hand|arm))?",
         "crosses the arms", "hands at the chest are shown as crossed arms"),
        (rf"\bput(?:s|ting)? {_OWN}hands? (?:in|into) {_OWN}pockets?\b|\bwith {_OWN}hands in {_OWN}pockets?\b", "",
         "hands in the pockets are not shown"),
        (rf"\bmov(?:es|ing) {_OWN}({_SIDE} )?(hands?|arms?)(?: [a-z]+){{0,3}}? (?:in )?(?:an? |the )?(?:[a-z]+ )?(?:circles?|circular (?:motion|path|movement))\b"
         r"(?: in front of (?:him|her|it|his belly|her belly|the body|his body))?", r"stirs the soup with the \1 hand", "a circling hand is shown as stirring"),
        (rf"\b(?:performs?|performing|makes|making|doing|does) (?:an? )?(?:circular|circling) (?:motion|movement)s? with {_OWN}({_SIDE}) (?:hand|arm)\b",
         r"stirs the soup with the \1 hand", "a circling hand is shown as stirring"),
        (rf"\bmov(?:es|ing) {_OWN}({_SIDE} )?(hands?|arms?) (?:quickly |slowly )?(?:up and down|from (?:up|top) to (?:down|bottom)|from (?:down|bottom) to (?:up|top)|upwards?)\b",
         r"raises the \1\2", "is shown as raising it"),
        (rf"\b(?:swing|rotat|shak)(?:s|es|ing) {_OWN}({_SIDE} )?(?:arms?|shoulders?)\b(?: around)?", r"circles the \1 arms", f"{_AS} circling the arms"),
        (r"\bcircl(?:es|ing) (?:the |his |her )?shoulders\b", "circles the arms", f"{_AS} circling the arms"),
        (rf"\b(?:roll|tilt|mov|rotat)(?:s|es|ing) {_OWN}head\b", "shakes the head", f"{_AS} shaking the head"),
        (rf"\blean(?:s|ing)? back(?:wards?)?(?: in {_OWN}chair)?\b", "stretches", "leaning back is shown as stretching"),
        # stairs and poses
        (r"\b(?:up|down|on|along) (?:an? |the )?(?:[a-z]+ )?(?:ramp|slope|hill|incline|hillside|mountain)s?\b(?: in the forward direction)?|\b(?<=forwards and )upwards\b|\b(?:uphill|downhill)\b",
         "", "the slope is not shown"),
        # what is held, worn, not done or only slight
        (r",? (?:with|without) closing (?:his|her|its|the) feet\b|\bwithout (?:being in )?an? hurry\b|\bwithout hurry\b", "", "how the feet are set is not shown"),
        (r",? ?(?:while |and |by )?(?:is )?cross(?:es|ing) (?:his |her |the |one )?(?:feet|legs|foot)(?: (?:behind|over) (?:the |an)?other)?(?=$|[,.]| and)", "", "that the legs cross is not shown"),
        (r",? ?(?:and |while )?(?:it |he |she )?(?:is )?(?:has |hav(?:e|ing) |hold(?:s|ing) )(?:its|his|her|their) (?:hands?|arms?) (?:like|as if) [a-z ']+?(?=$|[,.]| and (?:makes|walks|kicks|turns))", "", "how the hands are held is not shown"),
        (r",? ?(?:while |by |and )?(?:using (?:his |her |its |the )?(?:left |right )?hand (?:as (?:additional )?support|to prop against the floor)|support(?:ing|s) (?:his|her|its|this|the) ?(?:weight)? ?(?:with|on|by) (?:the |his |her )?(?:left |right )?hands?"
         r"|with (?:his |her |its |the )?(?:hands?|support of (?:two|both|his|her) hands?)(?: as support)?(?= and assumes|$|[.,])|stabili[sz]ing (?:him|her|it|them)sel(?:f|ves) with (?:the |his |her )?(?:left |right )?hand)", "", "the support of the hands is not shown"),
        (r",? (?:bent at the elbows?|elbows (?:are )?bent|fingers? (?:spread|stretched)|palms? (?:up|down|forward))(?=$|[,.]| and| then)", "", "how the arm is bent is not shown"),
        (r"\bpass(?:es|ing) it (?:over )?(?:to )*the (?:left|right)(?: hand)?\b|\bpass(?:es|ing) it from (?:one hand|the (?:left|right)(?: hand)?) to [a-z ]+?(?=$|[,.]| and)", "", "that it changes hands is not shown"),
        (r"\b(?:in an? )?(?:weird|strange|funny|odd|silly) (?:form|way|manner)\b|\bas if (?:he |she |it )?(?:carr(?:ies|ying)|is carrying|lift(?:s|ing)) [a-z ]+?(?=$|[,.])", "", "how odd it looks is not shown"),
        (r"\bwhile (?:bowing|bonding|bending)(?: forwards?| over| (?:his|her|their|its) backs?)?(?= *(?:$|[,.;<]|and\b|then\b|as\b))|\b(?:slightly |a bit )?slouched\b|\bwith (?:his|her) head (?:lowered|down)\b", "", "the bent back is not shown"),
        (r"\b(?:a |the )?(?:little |small )?(?:inclination|higher ground)\b", "", "the slope is not shown"),
        (r"\bwalk(?:s|ing)? on the tips of (?:his|her|its|the) toes\b", "walks slowly", "tiptoes are not shown"),
        (r"\b(?:is )?(?:doing|does|performs?|performing|makes?|dances|dancing) (?:\d+ times )?(?:the |an? )?(?:basic )?(?:steps? of (?:the |an? )?)?(?:slow[- ]?|wiener |viennese )?(?:waltz|wal[sz]er|cha[- ]cha(?:[- ]cha)?|tango|salsa)(?: ballroom)?(?: dance| move| steps?)?\b", "dances", "the kind of dance is not shown"),
        (r"\bdances? one part of a couple dance\b", "dances", "the partner is not shown"),
        (r"\b(?:performs?|does|makes|doing) (?:an? )?(?:golf putt|mini-?golf)(?: motion)?\b|\b(?:doing |does |making |makes )?an? swing(?: movement)? (?:like|while|as if) (?:hitting a ball with a golf club|playing golf)\b|\btakes? an? swing like while playing golf\b", "plays golf", "is shown as a golf swing"),
        (r"\b(?:doing |does |makes )?an? tennis racket(?: like)? (?:movement|motion)\b|\bhit(?:s|ting) (?:something |a ball )?with a racket(?: on (?:his|her) (?:left|right))?\b", "plays golf", "a swing with a racket is shown as a golf swing"),
        (r"\b(?:performs?|performing|does|makes|making) (?:a |the )?(?:circular|circling) (?:motion|movement)s? with (?:the |his |her |its )?((?:left|right) )(?:hand|arm)\b(?: (?:possibly|like|as if)[a-z ]*)?", r"stirs the soup with the \1 hand", "a circling hand is shown as stirring"),
        (r"\bmakes? with both (?:hands|arms) (?:big |large |small )?circles(?: in the air)?\b", "circles the arms", f"{_AS} circling the arms"),
        (r"\b(?:performs?|performing|does) digging (?:moves?|motions?|movements?)(?: like with a shovel)?\b|\bshovel(?:s|ing)\b|\bdig(?:s|ging)\b", "sweeps", f"{_AS} sweeping"),
        (r"\bgesticulation\b|\bcomplex (?:gestures?|sequence)\b", "waves", f"{_AS} waving"),
        (r"\b(?:performs?|displays?|makes) (?:complex |some )?(?:gestures?|waves)(?: displaying [a-z]+)? (?=with both hands)", "waves ", f"{_AS} waving"),
        (r"\bhunker(?:s|ing) down\b", "crouches", f"{_AS} crouching"),
        (r"\b(?:as if|like) (?:cleaning|wiping) (?:an? |the )?[a-z]+\b(?: (?:at|in) [a-z]+ (?:hight|height))?", "wipes the table", f"{_AS} wiping"),
        (r"\b(?:on|in|at) the same (?:hight|height) (?:as|of|like) (?:his|her|its) hips?\b|\bat (?:breast|hip|chest|head)[- ](?:hight|height|level)\b", "", "the height is not kept"),
        (r"\bover-?stepp?(?:s|ing) (?:an? )?(?:wide |big )?obstacle\b", "", "the obstacle is not shown"),
        (r"\bhit(?:s|ting)? an? obstacle while moving(?: forwards?)?\b", "walks, then stumbles", f"{_AS} stumbling"),
        (r"\bwalk(?:s|ing)?(?: straight| forwards?)* into an? (?:obstacle|wall|object)\b", "walks, then stumbles", f"{_AS} stumbling"),
        (r"\bflex(?:es|ing) (?:his|her|its|their) (?:biceps|muscles)\b", "raises both hands", f"{_AS} raised arms"),
        (r"\bturn(?:s|ing)? (?:an? |the |multiple |some )?wheels?\b", "stirs the soup", "a turning hand is shown as stirring"),
        (r"\b(?:tak(?:es|ing)) an? (?:hand )?shower\b", "combs the hair", "washing is shown as combing"),
        (r"\b(?:does|doing|performs?) (?:the )?chicken (?:moves?|dance)\b", "circles the arms", f"{_AS} circling the arms"),
        (r"\bperforms? (?:material|martial) arts\b", "punches, then kicks", f"{_AS} a punch and a kick"),
        (r"\bjumps? like an? [a-z]+ dancer\b", "jumps", "the kind of jump is not shown"),
        (r"\bget(?:s|ting)? (?:the|his|her|its) arms up in a defen[sc]e position\b", "hands_up", "the guard is shown as hands held up"),
        (r",?(?: but| and)? (?:without|no|not) (?:any |really )?(?:bending|closing|running|haste|moving|stopping|stepping|lifting|using|touching)\b[a-z ]*?(?=$|[,.]| and\b| then\b)",
         "", "what is not done is left out"),
        (r",? ?(?:and |while |with )?(?:slightly |a (?:little )?bit )?(?:drift(?:ing|s)?|moving slightly|deviat(?:es|ing)|tilted) (?:a bit )?(?:first )?(?:to|towards) (?:the |his |her |its )?(?:left|right)(?: side| hand side)?(?: then to the (?:left|right))?",
         "", "a slight drift to one side is not shown"),
        (r",? ?(?:and |while |with )?(?:his |her |its |the |pretty |very |slightly |a little bit of )*(?:(?:arms? (?:bent|dangling|hanging|relaxed)(?: casually)?(?: alongside| down)?)|(?:dangling|bent|stiff|relaxed) (?:arms?|legs?|upper body)"
         r"|(?<!left )(?<!right )hands? (?:at|on) (?:chest|hip|head) (?:level|height)|(?:hips? (?:swaying|swinging)|(?:swaying|shaking|swinging) hips?))\b(?: and (?:a )?(?:little bit of )?(?:stiff upper body|shaking hips))?",
         "", "how arms, hips or legs are held is not shown"),
        (r",? (?:with )?(?:a )?radius (?:of )?(?:approximat\w*|about|around|circa|ca\.?)? ?\d+(?:[.,]\d+)? ?(?:m|cm|meters?|metres?|centimeters?)\b"
         r"|\bwith (?:a )?(?:radius of )?(?:approximat\w*|about)? ?\d+(?:[.,]\d+)? ?(?:m|cm|meters?|metres?) radius\b", "", "the radius is not kept"),
        (r"\b(?:while |and )?(?:is )?hold(?:s|ing) (?:an? |the |his |her |some )?(?:heavy |small |big |imaginary )?(?:objects?|something|items?|bars?|boxe?s?|stick|bottle|balls?)\b(?= (?:with|in|and|while)|[,.]|$)",
         "", "what is held is not shown"),
        (r"\b(?:while |and )?hold(?:s|ing) (?:his|her|its|their) (?:injured|hurt|broken|hurting|aching) (?:left |right )?(?:upper )?(?:leg|knee|foot)(?: with [a-z ]*hands?)?", "limping", f"{_AS} a limp"),
        (r"\b(?:while |and )?hold(?:s|ing) (?:his|her|its|their) (?:left |right )?(?:upper )?(?:legs?|knees?|back|hip|arm|elbow)\b(?: with (?:both |his |her |the )*hands?)?(?=$|[,.]| and)", "", "a hand on the body is not shown"),
        (r"\b(?:while |by )?using (?:his |her |its |their |both |the )?(?:both )?(?:left |right )?(?:hands?|legs?)(?: and knees)? (?:as|for) (?:an? )?(?:support|help|counterbalance|balance)\b"
         r"|\b(?:while )?support(?:ed|ing (?:himself|herself|itself|themselves)) (?:on|by|with) (?:his|her|its|the|their|both) hands?\b|(?<=up) using (?:his|her|its|their) hands(?=$|[.,])",
         "", "the support of the hands is not shown"),
        (r"\b(?:while |and )?look(?:s|ing) (?:forwards?|ahead|back|behind|straight ahead)(?: (?:at|to|over) [a-z ]+?)?(?=$|[,.]| and\b)", "", "a look is not shown"),
        (r"\blike (?:he|she|it) (?:is|was|were) (?:[a-z]+ing)(?: [a-z]+ (?:a|the) [a-z]+)?\b", "", "what it looks like is not shown"),
        (r"\bshuffle (?=steps?\b)", "", "that the feet shuffle is not shown"),
        # down
        (r"\b(?:lift|heav)(?:s|es|ing)? (?:up )?(?:something|an object|a (?:heavy )?(?:box|object|thing|weight|stone))(?: heavy)?(?: up)? (?:over|above) (?:his|her|its|the|their) head\b",
         "picks something up, then raises both hands", "is shown as picking up, then raised hands"),
        (r"\b(?:is |gets? |getting |goes |going |go )(?:down )?(?:to the (?:floor|ground) )?(?:on the (?:floor|ground) )?(?:on|onto|to) all[- ]fours?\b",
         "kneels down", "all fours are shown as kneeling"),
        (r"(?<=crawling)(?: [a-z]+)? on all[- ]fours?\b|(?<=crawls)(?: [a-z]+)? on all[- ]fours?\b", "", "is shown as crawling"),
        (r"\b(?:goes|gets|getting|going|go|get) down to the (?:floor|ground)(?: having (?:his|her|its) knees and (?:his |her |its )?hands (?:at|on) the (?:ground|floor))?\b", "kneels down", "is shown as kneeling down"),
        (r"\b(?:lift|heav)(?:s|es|ing)? (?:up )?(?:something|an object|a (?:heavy )?(?:box|object|thing|weight|stone))\b(?: up)?", "picks something up", f"{_AS} picking something up"),
        # hands
        (r"\b(?:draw|mak|do|perform|describ)(?:s|es|ing|e)? (?:an? |some |two |several )?(?:big |small |large )?(?:circles?|circular (?:motions?|movements?)|circling (?:motions?|movements?)|cirles?)"
         rf"(?: in the air)?(?: in front of (?:them|him|her|it|his body))? (?:with|using) {_OWN}((?:left|right) )?(?:hands?|arms?)\b(?:,? (?:parallel to the (?:ground|floor)|in front of [a-z ]+?|at hips? high(?:t)?))*(?=$|[,.]| and| while)",
         r"stirs the soup with the \1 hands", "circling hands are shown as stirring"),
        (rf"\bmov(?:es|ing) (?:his or her |{_OWN})((?:left|right) )?(?:hands?|arms?) (?:(?:counter[- ]?)?clockwise )?in (?:an? |the form of an? )?(?:half )?circles?\b[a-z ,]*", r"stirs the soup with the \1 hand", "a circling hand is shown as stirring"),
        (r"\bmov(?:es|ing) (?:his|her|the|its|both) hands together(?: in front of (?:the|his|her) (?:chest|body))?\b", "claps once", "hands put together are shown as a clap"),
        (r"\b(?:rais(?:es|ing)|lift(?:s|ing)|hold(?:s|ing)|keep(?:s|ing)|has) (?:up )?(?:his|her|their|its|both|the) (?:fists?|hands|arms) (?:up )?(?:in front of (?:his|her|its) (?:upper body|body|face|head|chest)|for defen[sc]e|in (?:a )?defen[sc]e position|like a boxer)",
         "hands_up", "the guard is shown as hands held up"),
        (r"\b(?:is )?in (?:an? )?(?:fighting|fighter'?s?|boxing|boxer'?s?|defen[sc]e|defensive|combat|guard(?:ed)?) (?:position|stance|pose|posture)\b", "hands_up", "the guard is shown as hands held up"),
        (r"\bhold(?:s|ing)? (?:his|her|their|its|both) (?:hands?|arms?) (?:in front of|before) (?:them|him|her|it|himself|herself|the body|his body)\b", "stretches both arms forwards", f"{_AS} arms held out"),
        (rf"\b(?:mov|wav|flapp?)(?:es|ing|s) {_OWN}(?:arms?|wings?|hands?)(?: up and down)? like (?:an? )?(?:wings?|chicken|bird|eagle|butterfly)\b|\b(?:act(?:s|ing)|mov(?:es|ing)|impersonat(?:es|ing)|imitat(?:es|ing)) (?:like )?(?:an? )?(?:chicken|bird|duck)\b(?: flapping (?:its|his) wings)?|\bflap(?:s|ping) (?:its|his|her|their) (?:arms|wings)\b",
         "circles the arms", f"{_AS} circling the arms"),
        (r"\b(?:beat|slap|hit)(?:s|ting|ping|ing)? (?=with (?:his|her|its|the) (?:left|right) (?:hand|arm))", "punches ", f"{_AS} punching"),
        (r"\b(?:performs?|does|makes|making) (?:an? )?(?:hard |strong )?(?:slap|hit|blow) (?=with (?:his|her|its|the) (?:left|right) (?:hand|arm))", "punches ", f"{_AS} punching"),
        (r"\b(?:performs?|does|makes|making)? ?(?:an? )?(?:hard |strong |light )?(?:hit|stroke|swing|shot)s? with an? (?:mini-?)?golf[- ]club\b", "plays golf", "is shown as a golf swing"),
        (r"\b(?:base ?ball )?pitch(?:es|ing)\b", "throws a ball", f"{_AS} throwing a ball"),
        (r"\b(?:performs?|does|makes|making) (?:an? )?drumming (?:motion|movement)s?\b", "knocks", f"{_AS} knocking"),
        (r"\b(?:point|show)(?:s|ing)? (?:to )?(?:up|upwards?|the sky|the ceiling)\b", "raises the right hand", f"{_AS} a raised hand"),
        (r"\bhigh[- ]?fives?\b", "raises the right hand", f"{_AS} a raised hand"),
        (r"\bshoots? (?:with )?(?:a |the )?(?:gun|pistol|rifle)\b", "points ahead", f"{_AS} pointing"),
        (r"\bpaddl(?:es|ing)\b(?: in the air)?", "circles the arms", f"{_AS} circling the arms"),
        (r"\bwiggl(?:es|ing) (?:his|her|its|the|their) (?:upper body|hips?|body|torso)\b", "dances", f"{_AS} dancing"),
        # balance and ways
        (r"\bbalanc(?:es|ing)\b(?: (?:over|on|along|across|something)(?: (?:an? |the )?(?:small |narrow )?[a-z]+)?)?(?= while|$|[.,]| and)", "walks slowly", "balancing is shown as walking slowly"),
        (r"\b(?:moves?|walks?|walking|moving) (?:very )?unsteadily\b(?:, (?:perhaps|maybe)? ?drunk[a-z ]*)?|\b(?:intoxicated|alcoholi[sz]ed)\b|(?:\b(?:walks?|walking|moves?) )?without (?:a )?stable posture\b", "staggers", "an unsteady gait is shown as staggering"),
        (r"\bturn(?:s|ing)? (?:around )?on (?:his|her|its|their|the) (?:left |right )?(?:heels?|foot)\b", "turns around", "on which foot it turns is not shown"),
        (r"\b(?:dodg|avoid|evad)(?:es|s|ing) (?:an? |and |the |some )?(?:moving |big |small )?obstacles? to (?:the|its|his) (left|right)\b", r"sidesteps to the \1", f"{_AS} a step aside"),
        (r"(?:,? (?:and|while))? ?\b(?:dodg|avoid|evad)(?:es|s|ing) (?:an? |and |the |some )?(?:moving |big |small )?obstacles?\b(?: while walking)?", "", "the obstacle is not shown"),
        (r"\b(?:over|around|into|onto) (?:an? |the |some )?(?:[a-z0-9]+ ){0,2}(?:obstacles?|hurdles?)\b(?: by putting one (?:leg|foot) after (?:the other|another))?", "", "the obstacle is not shown"),
        (r"\bcross(?:es|ing) (?:an? |the )?(?:high |low |large )?obstacles?\b", "walks", f"{_AS} walking"),
        (r"\b(?:bump|crash|collid)(?:s|es|ing)? (?:into|with|against) (?:an? |the |some )?(?:[a-z]+)\b(?: to (?:his|her|its|the) (?:left|right))?", "stumbles", f"{_AS} stumbling"),
        (r"\b(?:is )?(?:bend|lean)(?:s|ing)? (?:the |his |her |its )?(?:upper body |body |torso )?back(?:wards?)?\b(?! and forth)", "stretches", "bending backwards is shown as stretching"),
        (r"\b(?:is |starts )?(?:warming|warms)[- ]up\b|\b(?:is )?loosening(?: up)?\b", "circles the arms", f"{_AS} circling the arms"),
        (r"\bdanc(?:es|ing) the (?:swing|twist|jive|cha)\b|\b(?:does|dancing) the (?:wiener|viennese) wal(?:z|tz)(?:er)?\b|\bbreak[- ]?danc(?:es|ing)\b", "dances", "the kind of dance is not shown"),
        (r"\b(?:performs?|does) (?:some (?:kind of )?|an? )?kata\b|\bfenc(?:es|ing)\b", "punches", f"{_AS} punching"),
        (r"\b(?:in|at|with|by) an? (?:[a-z]+[- ]?){0,3}degrees? angle\b", "", "the angle is not kept"),
        (r"\bgo(?:es|ing)? on an trajectory\b|\bmoves? somewhere\b", "walks", f"{_AS} walking"),
        (r"\b(?:climb|walk|go|run|step|jog|ascend|descend|com|mov|hurr|march|rac|jump)(?:s|es|ing|ies|ping|ning)?(?: (?:slowly|quickly|carefully|back))*"
         r"(?: (?:straight |back )?(?:up and down|up|down|on|onto|over|to))?(?: (?:of|on|onto))?(?: (?:the|an?|some|a few|one|two|three|four|five|several|small|little|high|short))*"
         r" (?:flight of )?(?:stairs?|staircases?|stairways?|stairwell|steps(?= (?:up|down)\b)|ladders?|upstairs|downstairs|podest|platform|curb|stepladder)(?: steps?)?(?: (?:up|down))?\b"
         r"|\b(?:up|down)(?: the| some| a few| two| three| four| five)* steps\b|\b(?:upstairs|downstairs)\b",
         "step_up_and_down", "stairs are shown as stepping up and down on the spot"),
        (r"\b(?:does|doing|practi[cs]es|performs?|performing) (?:some )?yoga(?: exercises?| poses?| positions?)?\b|\byoga (?:exercises?|poses?|positions?)\b",
         "in the tree pose, then the warrior pose", "yoga is shown as two of its poses"),
        (r"\b(?:(?:walk|step|go|climb|jump|mov|hop)(?:s|es|ing|ping)? )?(?:straight )?(?:up|down|onto|off)(?: an?| one| two| the)?(?: small| little| high| low)* (?:step|stair)s?\b(?! (?:forward|back|ahead|to))",
         ", step_up_and_down", "stairs are shown as stepping up and down on the spot"),
        # sport
        (r"\b(?:exercises|works? out|training|(?:warm(?:ing|s)?[- ]?up|fitness|floor|gym(?:nastic)?s?) (?:exercises?|training)|"
         r"does (?:some )?(?:warm[- ]?ups?|exercises?|gymnastics|yoga|pilates)|gymnastics|yoga|pilates)\b", "circles the arms", f"{_AS} circling the arms"),
        (r"\b(?:skip|jump)(?:s|ping|ing)? (?:with a |the )?(?:skipping )?rope\b", "hops", f"{_AS} hopping on the spot"),
        (r"\bburpees?\b", "squats, jumps", f"{_AS} a squat and a jump"),
        (r"\b(?:lift|us|exercis|train)(?:s|es|ing) (?:with )?(?:the |some )?(?:dumb-?bells?|weights|barbells?)\b|\bwith (?:weights|dumb-?bells)\b",
         "raises both hands", f"{_AS} raising both hands"),
        (r"\b(?:swing|hit)(?:s|ting|ing)? (?:an? |the |with an? )?(?:[a-z-]+ )?(?:bat|racket|racquet|stick|sword|paddle)\b|"
         r"\bplay(?:s|ing)? (?:table )?(?:tennis|baseball|badminton|hockey|ping-?pong|cricket|squash)\b"
         r"|\b(?:performs?|does) (?:an? )?(?:tennis|baseball|badminton) (?:serve|swing|stroke|smash|hit|pitch)\b|\btennis (?:serve|smash|swing)\b",
         "plays golf", "a swing with racket or bat is shown as a golf swing"),
        (r"\bplay(?:s|ing)? (?:some )?(?:soccer|football)\b", "kicks a ball", f"{_AS} kicking a ball"),
        (r"\bplay(?:s|ing)? (?:some )?(?:basketball|handball|volleyball|dodgeball|bowling)\b|\bshoots? (?:at|into) the basket\b|\bbowl(?:s|ing)\b|"
         r"\bjuggl(?:es|ing)\b" + _THING + r"|\bplay(?:s|ing)? with (?:a|the) ball\b|\btoss(?:es|ing)? a coin\b", "throws a ball", f"{_AS} throwing a ball"),
        (r"\bcatch(?:es|ing)? (?:an? |the )?(?:ball|something|object)\b", "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\bbounc(?:es|ing) (?:a|the) ball\b|\bdribbl(?:es|ing)\b" + _THING, "knocks", "is shown as a hand beating"),
        (rf"\b(?:hit|beat|strik)(?:s|es|ting|ing) (?:at |against )?(?:something|someone|somebody|an? [a-z]+|the [a-z]+|it)? ?(?=with {_OWN}{_SIDE} (?:foot|leg))",
         "kicks ", f"{_AS} kicking"),
        (r"\b(?:fight|spar)(?:s|ing|es)?(?: (?:against|with) (?:something|someone|somebody|an? [a-z]+))?(?: or someone)?\b(?! position)|"
         r"\b(?:hit|beat|strik)(?:s|es|ting|ing) (?:at |against )?(?:something|someone|somebody|an? (?:person|bag|object|opponent|wall)|the (?:air|wall|bag))\b",
         "punches", f"{_AS} punching"),
        (r"\b(?:does |doing |performs |some )?(?:kick-?boxing|karate|kung[- ]?fu|taekwondo|martial arts?)\b", "punches, then kicks", f"{_AS} a punch and a kick"),
        (r"\b(?:karate |kung[- ]fu |martial arts? |kick-?)(?=fighter|boxer|man|woman|person)", " ", "the kind of fighting is not shown"),
        (r"\b(?:dodg|evad|avoid|duck)(?:es|s|ing) (?:an? |the |something|some )?(?:(?:punch|hit|blow|attack|kick|ball)(?:es|s)?)?(?: to (?:his|the) (?:head|face|body))?"
         r"|\b(?:does|makes|performs) (?:an? )?(?:dodg(?:e|ing)|evasive) (?:move(?:ment)?|motion)\b", "crouches ", f"{_AS} crouching"),
        (r"\bhold(?:s|ing)? (?:an? |the )?squat(?:ted)?(?:ting)? position\b", "crouches", f"{_AS} crouching"),
        (r"\b(?:danc(?:es|ing)|moves?|moving|does|doing|performs?|performing|practi[cs]es?|steps?)? ?(?:the |an? |some )?(?:basic |standard )?"
         r"(?:steps? |movements? |motions? )?(?:of |in )?(?:the |an? )?(?:slow |fast |viennese |latin )?[- ]?"
         r"(?:waltz(?:es|ing)?|tango|salsa|ballet|cha-?cha-?(?:cha)?|rumba|samba|foxtrot|fox trot|quickstep|hip-?hop|polka|swing dance|ballroom)"
         r"(?: dance| dancing| steps?| moves?| motion| pirouette)*(?: basic steps?)?\b", " dances ", "the kind of dance is not shown"),
        (r"\b(?:danc(?:es|ing)) (?:with (?:an?|his|her|the|another|a imaginary) (?:[a-z]+ )?(?:partner|person|human|woman|man))\b", "dances",
         "the partner is not shown"),
        (r"\bdodg(?:es?|ing)\b", "crouches", f"{_AS} crouching"),
        (rf"\bmov(?:es|ing) {_OWN}({_SIDE} )?(hands?|arms?)\b(?: around| quickly| slowly| back and forth| horizontally| to (?:the|its|his) (?:left|right)| clockwise| in front of [a-z ]+)*(?=$|[.,])",
         r"waves with the \1\2", f"{_AS} waving"),
        (r"\b(?:over|around|into|onto) (?:an? |the |some )?(?:[a-z]+ )?(?:obstacles?|objects?|hurdles?)\b", "", "the obstacle is not shown"),
        # gaits
        (r"\b(?:tip-?toe(?:s|ing)?|walk(?:s|ing)? on (?:his |her |the |their )?(?:tip-?)?toes|walk(?:s|ing)? on tip-?toes?)\b", "walks slowly", "tiptoes are not shown"),
        (r"\b(?:sneak|creep|lurk|prowl|tiptoe)(?:s|ing)?\b(?: around)?", "walks slowly", f"{_AS} walking slowly"),
        (r"\b(?:shuffl|trudg|dawdl|plod|waddl|toddl)(?:s|es|ing)\b", "walks slowly", f"{_AS} walking slowly"),
        (r"\b(?:hurr(?:ies|ying)|rush(?:es|ing)?|storms|dash(?:es|ing)?)\b", "walks quickly", f"{_AS} walking quickly"),
        (r"\b(?:leav(?:es|ing)|exits?|exiting|walks? (?:off|out))(?: (?:the )?(?:room|scene|house))?\b", "walks away", f"{_AS} walking away"),
        (r"\b(?:enter(?:s|ing)?|comes? in(?:to)?)(?: (?:the |a )?(?:room|house|kitchen|scene))?\b", "walks", "coming in is shown as walking"),
        (rf"\b(?:with|has|having) (?:an? |the )?(?:injured|hurt|broken|stiff|sore|bad) (?:{_SIDE} )?(?:leg|foot|knee|ankle)s?\b|\bdragg?(?:s|ing) {_OWN}(?:{_SIDE} )?(?:leg|foot)(?: behind)?\b",
         "limping", f"{_AS} a limp"),
        (r"\b(?:like (?:an? )?)?(?:shaky|unsteady|unstable|zombie|dizzy)[- a-z]*?(?=(?: walk| and | to |$|[.,]))", "drunk", "an unsteady gait is shown as staggering"),
        (r"\blike (?:an? )?(?:zombie|drunk(?:ard)?|monster)\b", "drunk", "is shown as staggering"),
        (r"\b(?:bent (?:over|forwards?|down)|hunched(?: over)?|stooped|stooping|with (?:an? )?(?:stoop|bent back|hunched back|hunch)|crouched|in (?:an? )?(?:crouch|bent)[a-z ]*?position)\b",
         "", "the bent back is not shown"),
        (r"\b(?:on|over|along|across) (?:an? |the )?(?:[a-z]+ )?(?:beam|line|plank|rope|tightrope|rail|bridge|rough terrain|uneven ground|flat ground)\b", "", "what is walked on is not shown"),
        (r"\b(?:high|raised|lifted) knees\b|\bwith high steps?\b", "", "how high the knees go is not shown"),
        (r"\bdiagonal(?:ly)?\b(?: across the room)?", "", "a diagonal is shown as some direction"),
        (r"\b(?:in |along )?(?:an? )?zig-?zag(?:s| line)?\b|\bslalom\b|\bin (?:random |some |several )?curves\b|\bin an? (?:non-straight|wavy) line\b",
         "in a 60 degree curve to the left, then walks in a 60 degree curve to the right", "is shown as two curves"),
        (r"\b(?:in |along )?(?:an? )?(?:square|rectangle|rectangular path|triangle)\b", "in a circle", "is shown as a circle"),
        (r"\b(?:changes?|changing) (?:his |her |its |the )?(?:walking )?direction\b", "turns around", f"{_AS} turning around"),
        (r"\b(?:accelerat(?:es|ing)|decelerat(?:es|ing)|slow(?:s|ing) down|speed(?:s|ing) up|getting faster|gets faster)(?: again| slightly| a bit)?\b", "",
         "a change of speed is not shown"),
        (r"\b(?:as if|like|as though) (?:(?:he|she|it|they|a|the) )?(?:person )?(?:is |was |were |got |gets |had )?(?:been |being )?"
         r"(?:pushed|shoved|hit|puched)[a-z ]*", "", "what it looks like is not shown"),
        (r"\blike (?:an? )?(?:crab|robot|model|soldier|bodybuilder|wings?|bird|plane|airplane|duck|penguin|ape|monkey|old man|stork|chicken|dog|cat|boxer|bodybuilder|dancer)s?\b|\bcrab-?wise\b", "",
         "whom it resembles is not shown"),
        (r"\b(?:jump|hop)(s|ing)? (?:up )?(?:and |while )(?:turn(?:s|ing)?|rotat(?:es|ing)|spin(?:s|ning)?)\b(?! \d)", "jumps, then turns",
         "jump and turn are shown one after the other"),
        # nothing that moves
        (r"\b(?:laugh|sing|smil|grin|cr(?:y|i)|whistl|shout|scream|talk|speak|chat|listen|think|hum|snor|blink|wink|sniff|rest|relax|"
         r"worr(?:y|i)|dream|hesitat|concentrat|meditat)(?:s|es|ing|ning)?\b(?: (?:about|to|with|at|of) [a-z ]+?(?=$|[,.]| and | then | while ))?(?: (?:loudly|quietly|calmly|softly))?",
         "", "has no movement that is shown"),
        (r"\b(?:do(?:es|ing)) nothing\b|\b(?:does|doing) (?:some )?breathing exercises\b", "stands still", "is shown as standing still"),
        (r"\b(?:watch(?:es|ing)?|looks? at|looking at|looks? out of|observ(?:es|ing)|star(?:es|ing) at|glanc(?:es|ing) (?:at|occasionally at)|examin(?:es|ing)|inspect(?:s|ing)?)"
         r" (?:it|him|her|them|(?:the |a |an |his |her |their |its )?[a-z]+(?: mirror| window)?)\b", "", "a look is not shown"),
        (r"\b(?:look(?:s|ing)? for|search(?:es|ing)?(?: for)?|seek(?:s|ing)?)\b" + _THING, "looks around", f"{_AS} looking around"),
        (rf"\b(?:with )?{_OWN}eyes (?:closed|shut|open)\b|\bclos(?:es|ing) {_OWN}eyes\b", "", "eyes are not shown"),
        (r"\bfalls? asleep(?: on the (?:sofa|couch|chair|bed))?\b|\b(?:sleep|nap|snooz)(?:s|es|ing|ping)?\b", "lies on the floor", f"{_AS} lying"),
        (r"\bwak(?:es|ing) up\b", "lying on the floor, gets up", f"{_AS} getting up"),
        (r"\b(?:against|on) the wall\b", "", "the wall is not touched"),
        (r"\blean(?:s|ing) (?:against|on)\b" + _THING, "stands", "is shown as standing"),
        (r"\b(?:feels?|is|being|looks?) (?:sick|ill|tired|dizzy|happy|sad|bored|nervous|angry|afraid|confused)\b", "", "how it feels is not shown"),
        (r"\bvomit(?:s|ing)?\b|\bthrows? up\b(?= *$| because)", "bends down", f"{_AS} bending down"),
        (r"\b(?:gets?|getting) (?:dressed|undressed|changed)\b", "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\b(?:put|tak|get|plac)(?:s|es|ting|ing)? (?:on |off |out )?(?!(?:a )?(?:step|seat|steps|turn|few|one|two|three|four)\b|(?:his|her|the|both|its) (?:left |right )?(?:arms?|hands?|legs?|foot|feet|knees?)\b|up\b|back\b|down\b)"
         rf"{_OWN}(?:jacket|coat|shoes?|boots?|shirt|sweater|pullover|trousers|pants|dress|bag|backpack|gloves|scarf|apron|something|things?|objects?|items?|clothes|toys?|books?|bottle|glass|plates?|groceries|keys?)\b{_THING}",
         "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\b(?:snap|flick)(?:s|ping|ing)? (?:his |her |the )?fingers?\b|\bshak(?:es|ing) (?:a|his|her|the) fist\b", "waves", "a moving hand is shown as waving"),
        (r"\b(?:staple|load|unload|assembl|repair|fix|examin|handl)(?:s|es|ing)\b" + _THING, "reaches for something twice", f"{_AS} reaching out with the hands"),
        (r"\bdrops? (?:a |an |the |his |her |something|some )[a-z ]*?(?=$|[,.]| and| then)", "reaches for something", "letting go is shown as reaching out"),
        (r"\bcross(?:es|ing) (?:the |his |her )?hands(?: in front(?: of (?:him|her|the body))?)?", "crosses the arms", f"{_AS} crossing the arms"),
        (r"\bcross(?:es|ing) the (?:room|street|floor|hall)\b", "walks", f"{_AS} walking"),
        (r"\b(?:swim|swimming|swims)\b(?: [a-z]*stroke| breaststroke| the crawl)?", "circles the arms", f"{_AS} circling the arms, standing"),
        (r"\bdriv(?:es|ing) (?:a |the |his |her )?(?:car|bus|truck)\b", "sits", "driving is shown as sitting"),
        (r"\brid(?:es|ing) (?:a |the |his |her )?(?:bike|bicycle|horse|motorbike)\b", "sits", "riding is shown as sitting"),
        (rf"\bmov(?:es|ing) {_OWN}({_SIDE} )?(hands?|arms?)\b(?! (?:and|up)\b)[^,.;]*?(?=$|[,.;]| and\b| then\b| while\b)", r"waves with the \1 \2", "a moving arm is shown as waving"),
        (r"\blower(?:s|ing) (?:his |her |the |both |its )?(?:left |right )?(?:arms?|hands?)\b(?: again)?(?=$|[,.])", "stands", "arms that go down are shown as hanging"),
        # kinds of sentences on a development draw
        (r"\b(?:evad|dodg|avoid|escap)(?:es|s|ing) (?:from )?(?:an? |the |some )?(?:[a-z]+ )?(?:obstacle|object|thing|something|person|ball|stone|hole)s?\b(?: (?:on|in|near) (?:the |his |her )?(?:floor|ground|way|path))?(?: by (?:stepping|walking|going) (?:around|over|past) it)?",
         "sidesteps", f"{_AS} a step aside"),
        (r"\b(?:mak|tak|do|perform)(?:es|ing|s)? (?:an? )?evasive (?:step|movement|manoeuvre|maneuver|action)\b", "sidesteps", f"{_AS} a step aside"),
        (r"\bplay(?:s|ing)? (?:hopscotch)\b", "hops on the right leg", f"{_AS} hopping on one leg"),
        (r"\b(?:smash|slam|bang|hurl)(?:es|s|ing)? (?:something|an? [a-z]+|it) (?:on|onto|to|against|at) (?:the )?(?:floor|ground|wall)\b", "throws something", f"{_AS} throwing it"),
        (r"\b(?:cast|throw)(?:s|ing)? (?:an? |the |his )?(?:fishing )?(?:line|lure|rod|hook|net)\b|\b(?:is |goes )?fishing\b", "throws something", "fishing is shown as a throw"),
        (r"\b(?:us|shoot|fir|aim)(?:es|s|ing) (?:with )?(?:an? |the |his |her )?(?:gun|rifle|pistol|weapon|bow|crossbow)\b", "points ahead", f"{_AS} pointing"),
        (r"\b(?:us|swing)(?:es|s|ing) (?:an? |the |his |her )?(?:axe|pickaxe|hammer|scythe|sword)\b|\bchop(?:s|ping) (?:some |the )?wood\b", "plays golf", "a swing with a tool is shown as a golf swing"),
        (r"\b(?:call|wav|beckon|invit|summon)(?:s|ing|es|on|oning)? (?:to |for )?(?:someone|somebody|a person|him|her|others) (?:to come|over|closer|here)(?: (?:closer|over|here))?\b", "waves", "beckoning is shown as waving"),
        (r"\b(?:select|choos|pick|switch|skip|search)(?:s|es|ing) (?:[a-z]+ )?(?:music|songs?|something|an? app|apps?|videos?) (?:from|on|with|in) (?:an? |the |his |her )?(?:smart|mobile |cell )?-?phone\b", "looks at the phone", f"{_AS} using a phone"),
        (rf"\b(?:tak|put|lift|bring|mov|rais)(?:es|s|ing|ting)? {_OWN}({_SIDE} )?(hands?|arms?) (?:up )?(?:over|above|on top of|behind) {_OWN}head\b", r"raises the \1 \2", f"{_AS} raised hands"),
        (r"\bcatch(?:es|ing)? (?:an? |the |some )?(?:[a-z]+ )?(?:ball|basketball|object|thing|something|it|frisbee)\b", "reaches for something", "a catch is shown as reaching out"),
        (r"\b(?:is |was )?(?:posing|poses)\b|\b(?:do|mak|strik|hold|tak)(?:es|s|ing|e)? (?:an? )?(?:[a-z]+ )?pose\b", "stands still", "the pose is not shown"),
        (rf"\b(?:hold|keep|rais|lift|put)(?:s|es|ing|ting)? (?:up )?{_OWN}fists?\b(?: up)?(?: high)?", "hands_up", "the guard is shown as hands held up"),
        (r"\bprotect(?:s|ing) [a-z ]*?(?:face|head|body)(?: with (?:his|her|its|the|both) (?:left |right )?(?:hands?|arms?))?", "hands_up", "the guard is shown as hands held up"),
        (r"\b(?:an? )?(?:kick-?box(?:ing|es)|martial arts|karate|kung[- ]fu)(?: kicks?)?\b(?= with (?:his|her|its|the) (?:left|right) (?:leg|foot))", "kicks", f"{_AS} kicking"),
        (r"\b(?:does|doing|performs|practi[cs]es|practi[cs]ing) (?:some )?(?:kick-?boxing|martial arts|karate|kung[- ]fu|basic (?:fighting|boxing) mov(?:es|ements))\b", "punches, then kicks", f"{_AS} a punch and a kick"),
        (r"\b(?:wind|wound|strik)(?:s|ing|es)? (?:up|out)(?: with (?:his|her|its|their|the) (?:left |right )?(?:hand|arm))?(?= and (?:throw|hit|punch|toss|pitch|smash))", "", "the wind-up is not shown"),
        (r"\b(?:gets?|moves?|takes?|pulls?) (?:the|his|her|its) (?:left |right )?arm (?:back|backwards?)(?= and)", "", "the wind-up is not shown"),
        (r"\b(?:performs?|does|makes|doing|performing) (?:an? )?(?:volley ?ball |tennis )?(?:slap|serve|smash|serving)\b", "throws something", f"{_AS} throwing"),
        (r"\b(?:beats?|hits?|swings?|plays?) (?:like )?(?:an? )?tennis(?: player)?\b|\bplay(?:s|ing) (?:table )?(?:tennis|badminton|squash|cricket|baseball)\b|\bswing(?:s|ing) (?:an? |the )?(?:baseball )?(?:bat|racket|racquet|club)\b",
         "plays golf", "a swing with a racket or bat is shown as a golf swing"),
        (r"\b(?:perform|mak|do)(?:s|es|ing)? (?:an? )?(?:slight |hard |light |strong )?(?:hit|stroke|shot|swing)s? (?:of a ball|with (?:an? )?(?:mini?-?)?golf ?-?club)\b|\b(?:makes?|performs?|doing|does) (?:an? )?(?:mini-? ?)?golf(?:ing)? (?:play(?:ing)? )?(?:like )?(?:motion|movement|swing)s?\b|\bhit(?:s|ting) (?:an? |the )?ball with (?:an? |the )?golf[- ]?club\b",
         "plays golf", "is shown as a golf swing"),
        (r"\bswing(?:s|ing) (?:the|his|her|a) club\b[a-z ]*?(?=$|[,.]| while)", "", "how the club swings is not shown"),
        (r"\b(?:perform|mak|do|show)(?:s|es|ing)? (?:an? |some )?(?:hand |arm )?(?:gestures?|signs?)(?: (?:with (?:his|her|its|the|both) (?:left |right )?hands?|displaying [a-z]+))?\b", "waves", "the gesture is shown as waving"),
        (r"\b(?:is )?steer(?:s|ing) (?:an? |the )?(?:car|bus|ship|wheel|vehicle)[a-z ]*|\bdriving (?:motion|movement)s?\b(?: with (?:its|his|her) arms)?", "stirs the soup with both hands", "steering is shown as stirring"),
        (rf"\b(?:tilt|lean)(?:s|ing)? (?:{_OWN}(?:body|torso|upper body) )?to (?:the|his|her|its) (?:left|right)(?: side)?\b", "stretches", "leaning to a side is shown as stretching"),
        (r"\b(?:lost|loses|losing|out of|off) (?:his |her |its |the )?balance\b", "stumbles", f"{_AS} stumbling"),
        (rf"\b(?:keep|hold|regain|maintain)(?:s|ing)? {_OWN}(?:balance|posture)(?: (?:by|with)(?: using)? [a-z ]+?)?(?=$|[,.]| and)", "", "the balance is not shown"),
        (r"\b(?:is |gets |was )?(?:scared|frightened|startled|surprised|shocked|afraid)(?: (?:of|by) [a-z]+)?\b", "", "the fright is not shown"),
        (r"\b(?:is )?(?:needs?|needing|taking|takes) (\d+|[a-z]+) steps (?:to (?:complete|finish|do|make) [a-z ]+)", "", "the number of steps is not kept"),
        (r"\bat (?:an? )?(?:slight )?(left|right) angle\b|\b(?:slightly )?angled to the (left|right)\b", r"in a 60 degree curve to the \1\2", "a slant is shown as a curve"),
        (r"(?:,? (?:and|with) )?(?:the |his |her )?(?:right|left) (?:foot|leg) (?:leading|following|first|in front)\b(?:,? (?:and )?(?:the |his |her )?(?:right|left) (?:foot|leg) (?:following|leading|behind))?", "", "which foot goes first is not shown"),
        (r",? ?(?:while )?putting (?:the|his|her|one) (?:left |right )?foot (?:directly |right )?(?:in front of|before|behind) (?:the|his|her) (?:other|left|right)(?: (?:foot|one))?", "", "how the feet are set is not shown"),
        (r"\b(?:with )?(?:nordic )?(?:walking |ski )?(?:sticks|poles|crutches|a cane|a stick|a walker)(?: in (?:his|her|the) hands?)?\b(?= *(?:$|[,.]))", "", "the sticks are not shown"),
        (r"\bon (?:his|her|its|the) (?:left|right) (?:foot|heel)\b(?= *(?:$|[,.]| and))", "", "on which foot is not shown"),
        (r"\b(?:is |being )?get(?:s|ting) ready(?: to (?:jump|run|walk|crawl|throw|kick))?\b|,? ready to [a-z]+", "", "getting ready is not shown"),
        (r"\b(?:hop|jump)(s|ing)? around\b", r"hop\1 ", "where it goes is not shown"),
        (r"\b(?:while )?keep(?:s|ing) (?:his|her|its|both|the) (?:hands|arms|fists) up\b", "", "the guard is not shown"),
        (r"(?:,? and|,) (?:imitat|mimic|impersonat|pretend)(?:es|s|ing|king)? (?:to be )?(?:an? |the )?(?:[a-z]+[- ])?(?:movements? of (?:an? )?)?(?:animal|ape|dog|monkey|penguin|elephant|chicken|cat|bird|robot|zombie)s?\b", "", "whom it imitates is not shown"),
        (r"\bcurls? it up\b|\bholds? it (?:on|at|in|to) [a-z ]+?(?=$|[,.]| and)", "", "what is done with it is not shown"),
        (r"\b(?:shout|laugh|scream|yell|cheer|cr(?:y|ie))(?:s|ing)?\b|\bis convulsed with laughter\b", "", "has no movement that is shown"),
        (r"\buntil (?:the |his |her |a )?(?:[a-z]+ ){1,3}(?:is|are|was) (?:empty|full|done|finished|over|clean|ready|gone)\b", "", "until when is not shown"),
        (r"\bexplor(?:es|ing) (?:the|its|his|her) (?:environment|surroundings|room)(?: with head mov(?:es|ements))?\b", "looks around", f"{_AS} looking around"),
        (r"\bcom(?:es|e|ing) back on (?:his|her|its) feet\b", "stands up", f"{_AS} standing up"),
        (r"\b(?:step|climb|walk|run|jump)(?:s|ping|ing|ning)? (?:over|on|onto|on top of|ontop of) (?:an? |one |the |some )?(?:small |high |low )?(?:steps?|objects?|something|box|boxes|stones?|puddles?|branch(?:es)?|logs?|thresholds?)\b", "step_up_and_down", "a step over it is shown as stepping up and down"),
        (r"\bplac(?:es|ing) (?:an? |the |some )?(?:pictures?|paintings?|things?|objects?|books?) (?:on|at|in) (?:an? |the )?(?:wall|shelf|table|desk)\b|\bput(?:s|ting)? it (?:in|into|on|onto) (?:the |a )?(?:shelf|table|desk|cupboard|box)\b", "reaches for something", f"{_AS} reaching out with a hand"),
        (r"\bholding (?:an? )?(?:squat(?:ted|ting)?|crouch(?:ed|ing)?) position\b|\bstays? in (?:an? )?squat\b", "crouches", f"{_AS} crouching"),
        (r"(?:(?:,|,? and|while) )?\b(?:is )?(?:hold|carry)(?:s|ing) (?:an? |the |some )?(?:[a-z-]+ ){0,2}(?:item|thing|object|weight|box|bag)s?\b", "", "what is held is not shown"),
        (r"\b(?:lift|heav)(?:s|es|ing)? (?:up )?(?:an? |the |some )?(?:[a-z-]+ ){0,2}(?:item|thing|object|weight|box|bag)\b(?: \([^)]*\))?", "picks something up", f"{_AS} picking something up"),
    )),
    *(Approximation(*row) for row in WHERE_UNKNOWN),
    Approximation(_NOT_DONE, "", "what is not done is left out", in_part=True),
)  # fmt: skip
_pattern = cache(re.compile)  # when first tried: most sentences need few of them, and all take 0.1 CPU-s
_HELD = re.compile(r"<(\d+)>")
_STEMS = re.compile(r"\\b\(\?:[a-z'|-]+\)\(\?:")  # patterns that begin with stems of verbs and their endings
_OF_A_NOUN = re.compile(r"(?<!performs )(?<!does )(?<!doing )(?<!makes )\b(?:an?|the|his|her|their|its|some|of)$")


def _is_noun(found: re.Match[str]) -> bool:
    """Whether what looks like a verb's plain form follows an article: "in a sort of", "a cook"."""
    plain = not re.match(r"[a-z]+(?:s|ed|ing)\b", found[0])
    return plain and _OF_A_NOUN.search(found.string[: found.start()].rstrip()) is not None


def with_approximations(text: str, *, only_always: bool = False, in_part: bool = False) -> str:
    """The sentence with what is known instead of what is not; a token after each replacement says which it was."""
    folded = text.lower()
    held: list[str] = []  # replacements, kept out of the text until all patterns have been tried
    for number, one in enumerate(APPROXIMATIONS):
        if (only_always and not one.always) or (one.in_part and not in_part):
            continue

        def hold(found: re.Match[str], number: int = number, one: Approximation = one) -> str:
            if _STEMS.match(one.pattern) and _is_noun(found):
                return found[0]
            held.append(f"{_filled(found, one.instead)} {MARK}{number}")
            return f" <{len(held) - 1}> "

        folded = _pattern(one.pattern).sub(hold, folded)
    return " ".join(_HELD.sub(lambda found: held[int(found[1])], folded).split()) if held else text


def _filled(found: re.Match[str], instead: str) -> str:
    """The replacement with the groups of the match in it."""
    return re.sub(r"\\(\d)", lambda group: found[int(group[1])] or "", instead)


def how_of(token: str) -> str:
    """What a token of `with_approximations` says."""
    return APPROXIMATIONS[int(token.removeprefix(MARK))].how
