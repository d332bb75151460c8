"""Phrases in which the side, the angle or the limb stands inside another phrase; put in order before all others."""

_OWN = r"(?:(?:his|her|its|their|the|both|own) )*"
_CLOCK = r"(?:(?:counter|anti)[- ]?)?clock[- ]?wise"
_HELD = r"(?:raised|stretched|extended|spread(?:ed)?|held|outstretched)(?: out)?"
_HAVING = r"(?:(?:has|have|having|with|holds?|holding|keeps?|keeping|puts?) )?"
_TO_SIDES = r"(?:to (?:the|both|his|her|its|their) sides?|sideways|horizontal(?:ly)?)"
_AHEAD = r"(?:forwards?|ahead|to the front|in front(?: of (?:him|her|it|them)(?:self)?)?)"

_TRUNK = rf"(?:{_OWN}(?:upper body|torso|trunk|body) )?"
_GAIT = r"walks?|walking|goes|going|runs?|running|jogs?|jogging|moves|moving|paces|pacing|strolls|strolling"
_WIDE = r"(?: (?:small|big|large|wide|tight|narrow|full|whole|complete))*"

_DOES = "(?:throws?|throwing|performs?|performing|does|doing|makes|making|lands?)"
_IN_FRONT = "(?:body|chest|face|head|belly|stomach|eyes|mouth|breast|nose)"
_PALM = r"(?:,? (?:the |with the )?palm (?:facing )?forwards?)?"
_STATE = (
    r"(?:hangs?(?: straight)?(?: down)?(?: (?:at|beside|by) (?:the|his|her) (?:side|body))?|(?:is|are) straight (?:up|down|forwards?|ahead)"
    rf"|(?:is|are) in front of (?:the|his|her) chest){_PALM}"
)

# Replaced in this order, before `gesture_phrases.GESTURE_PHRASES`.
SIDED_PHRASES: tuple[tuple[str, str], ...] = (
    (rf"\bbefore ((?:his |her |its |their |the |my )(?:own )?{_IN_FRONT})\b", r"in front of \1"),
    (r",? without (?:any |an? )?(?:pause|break|rest|stop|pausing|stopping|resting|interruption)s?\b(?: in between)?", " "),
    (r"\b(?:does|do|is|are)(?: not|n't) (?:move|moving)(?: at all)?\b|\bkeeps? (?:completely |very )?(?:still|motionless)\b", " waits "),
    (r"\b(?:with|on|using) each (leg|foot|hand|arm)\b", r"with the left \1, then with the right \1"),
    (r"\b(?:both|left and right) ((?:front|side)[- ]lunge)s?\b", r"left \1, then right \1"),
    # a limb that was named goes on: "stretches the right arm forward, then the hand returns to the chest"
    (r"\b(left|right) (arm|hand)\b([^.]*?(?:,|;|\band|\bthen) )(?:the|this|that) (arm|hand)(?= [a-z]+s\b)", r"\1 \2\3the \1 \4"),
    # how a limb is held before it moves: "the right arm hangs straight, is lifted straight up"
    (rf"\b({_OWN}(?:left|right) (?:arm|hand)|both (?:arms|hands)) {_STATE}(?:(?:,|;|and|then|it|they|both) ?)+"
     r"(?=(?:is|are|rises?|goes?|falls?|sinks?|drops?|returns?|comes?) )", r"\1 "),
    (rf"\b(?:holds?|has|puts?|brings?) {_OWN}(left|right) (?:hand|palm) (?:in front of|at|to) (?:the|his|her|their) chest(?:, (?:the )?palm forwards?)?"
     r"(?:,| and| then)+ (?:stretches|pushes|moves|extends) (?:it|the (?:hand|arm)) (?:straight )?(?:forwards?|out|ahead)\b",
     r"pushes the \1 hand forward from the chest"),
    (rf"\b((?:turn|spin|rotat|pivot)[a-z]*(?: [a-z]+){{0,3}}?) in an? ({_CLOCK}) (?:direction|motion|manner|fashion|way)\b", r"\1 \2"),
    # the trunk
    (rf"\b(?:leans?|leaning|tilts?|tilting|bends|bending) {_TRUNK}(?:over )?(?:to |towards )?(?:the |his |her |its |their )?(left|right)(?: side)?\b(?! (?:arm|hand|leg|foot|knee|elbow|wrist|hip|shoulder))", r" lean_over \1 "),
    (rf"\b(?:leans?|leaning|tilts?|tilting|bends|bending) {_TRUNK}(?:over )?(?:to (?:the|one|both|each) sides?|from side to side|sideways|left and right|side to side)\b", " lean_over "),
    (rf"\b(?:leans?|leaning|tilts?|tilting|bends|bending) {_TRUNK}(?:far |slightly |a bit )?back(?:wards?)?\b(?! (?:on|against|in|into|to|up))", " lean_over backwards "),
    (rf"\b(?:twist|rotat|swivel|turn)(?:e?s|ing) {_OWN}(?:upper body|torso|trunk|waist)\b(?: (?:from )?(?:side to side|left and right|left to right)| to (?:both sides|the left and (?:the )?right))?",
     " twist_trunk "),
    (rf"\btwist(?:s|ing)?(?: {_OWN}body)?(?: (?:from )?(?:side to side|left and right|left to right)| (?:at|from|in) the waist)", " twist_trunk "),
    (rf"\btwist(?:s|ing) {_OWN}body\b", " twist_trunk "),
    (r"\breach(?:es|ing)? (?:high )?(?:up(?:wards?)?|overhead)(?: high| in(?:to)? the air| overhead| above (?:the|his|her|their) head)?\b", " reach reach_high "),
    (r",? (?:but|and|yet|without)? ?(?:does|did|do|is)(?: not|n't) (?:fall|falling)(?: down| over)?\b", " "),  # true of all but falls
    (r"\b(?:rotat|mov|swivel)(?:e?s|ing) (?:his|her|its|their|the) head\b(?: (?:a?round|from side to side|in circles|up and down))?", " look_around "),
    (r"\bsquat(?:s|ting)?(?: down)?((?: (?:slowly|quickly|carefully|deeply|low))*) (?:and|then|,)+ (?:stays?|remains?|holds?|staying|remaining) (?:it|there|down|low|in (?:it|position|(?:this|that|the|a) (?:[a-z]+ )?(?:position|pose|posture|squat)))\b", r" crouches\1 "),
    (r"\b(?:nearly|almost) (?:falls?|falling|topples?|trips?|slips?)(?: (?:down|over|forwards?|backwards?))?\b", " stumbles "),
    # where somebody faces who walks anyway, and from where somebody gets up
    (r"\b(?:is |are )?fac(?:es|ing) (?:straight )?(?:forwards?|ahead)(?= and\b| then\b|,)", " stands "),
    (r"(?:,? (?:while|but|and))? (?:still |always |is )?fac(?:es|ing) (?:straight )?(?:forwards?|ahead)\b", " "),
    (r"\b(?:stand|get|ris)(?:s|ing|es)? up from (?:an? |the |his |her |their )?(?:seated|sitting) (?:position|pose|posture)\b", " stand_up "),
    (r"\brais(es|ing|e) ((?:both |his |her |its |their |the )*(?:left |right )?(?:arms?|hands?)) (?:up )?in(?:to)? the air\b", r"rais\1 \2 up"),
    (r"\b(pick(?:s|ing)?) (something|an? (?:object|item|thing))(?! (?:up|from|off|out))", r"\1 up \2"),
    # circles and curves
    (rf"\b(?:along|in|on|through|by) (?:an?|the) ({_CLOCK}) (?:path|direction|way|manner|motion|route|fashion)\b", r"in a circle \1"),
    (r"\bs[- ]shaped? (?=path|line|curve|way)|\bs shape\b", "s-shape "),
    (rf"\b({_GAIT})((?: [a-z]+ly)?)(?: in| along| around)? (two|three|four|five|[2-5]){_WIDE}(?: ({_CLOCK}|left|right))?{_WIDE} (?:circles|rounds)\b",
     r"\1\2 in_circle rounds_\3 \4 "),
    (rf"\b({_GAIT})((?: [a-z]+ly)?) ({_CLOCK})(?! (?:{_CLOCK}|circles?|rounds?|in|on|along|around|quarter|half|turn|a|\d))", r"\1\2 in a circle \3"),
    (r"\bturn(s|ing)? (?:at|round|around) (?:an?|the|some) (left |right )?corner\b", r"walk\1 around a \2corner"),
    (rf"\b({_GAIT}|turns?) an? (left |right )?corner\b", r"walks around a \2corner"),
    (r"\b(?:performs?|does|doing|makes|making|walks?|walking) (?:an? )?(?:full |complete |whole |tight |wide )*(\d+)[- ]?deg(?:ree)?s? (curve|bend|circle)\b",
     r"walks in a \1 degree \2"),
    (r"\b(?:walk|go|mov|run)(s|es|ing)?( around)? on (?:his |her |its |the )?(?:hands and knees|knees and hands|hands and feet)\b", r"crawls\2"),
    (r"\b(\w+) and (?:a )?half steps\b", r"\1 steps"),
    # where a walk comes from, a rest, more of the same
    (rf"\b({_GAIT})((?: [a-z]+ly)?) (?:in )?from (?:the |his |her )?left(?: side)?(?! to)\b", r"\1\2 to the right"),
    (r"\b(?:comes?|coming|steps|enters)((?: [a-z]+ly)?) (?:in |the room )?from (?:the |his |her )?left(?: side)?(?! to)\b", r"walks\1 to the right"),
    (rf"\b({_GAIT})((?: [a-z]+ly)?) (?:in )?from (?:the |his |her )?right(?: side)?(?! to)\b", r"\1\2 to the left"),
    (r"\b(?:comes?|coming|steps|enters)((?: [a-z]+ly)?) (?:in |the room )?from (?:the |his |her )?right(?: side)?(?! to)\b", r"walks\1 to the left"),
    (r"\b(?:rests?|resting|takes? an? (?:break|rest)|relaxes) (?=for \w+ seconds?)", "waits "),
    (r"\b(push-?ups|squats|lunges|jumping jacks|jumps|claps|bows|kicks|punches|steps)\b([^.;]*?)\b(does|makes|takes) (\w+) more\b(?! \w+s\b)",
     r"\1\2\3 \4 \1"),
    # a push that is received
    (r"\b(?:recovers?|recovering) from (?:the|this|that) (?:push|shove|hit|kick|punch|blow)\b", "recovers"),
    (r"\b(?:counterbalanc|compensat|balanc)(?:es|ing|e) (?:for )?(?:the |this |an? )?(?:push|shove|hit|kick|punch|blow)\b", "recovers"),
    (r"\b(?:absorb|tak|receiv)(?:s|es|ing) (?:an? |the )?(?:punch|blow|hit|shove)\b", "is pushed"),
    (r"\b(is|are|gets|was|being) push(?= (?:from|to|by|on|backwards?|forwards?|aside|away)\b| *$)", r"\1 pushed"),
    (r"\b(?:moves?|goes|walks?) ((?:[a-z]+ ){0,2})(?:in|at) an? ((?:[a-z]+ )?)(jog|run|trot|sprint)\b", r"\3s \1 \2"),
    (r"\b(look(?:s|ing)?) (?:suspiciously )?(?:to )?(?:the |his |her )?(?:left and (?:to )?(?:the |his |her )?right|right and (?:to )?(?:the |his |her )?left)\b",
     " look_around "),
    # with which hand
    (r"\bby using (his|her|its|their|the) (left|right) (hand|arm|foot|leg)\b", r"with \1 \2 \3"),
    (r"\b(left|right)[- ]handed (?:boxing )?(throw|punch|jab|wave|uppercut|hook)\b", r"\2 with the \1 hand"),
    (r"\b(left|right)[- ]handed\b(?! (?:person|man|woman|human|boxing|throw|punch|jab|wave))", r"with the \1 hand"),
    (r"\b(?:both|two)[- ]handed\b", "with both hands"),
    (rf"\b(quarter|quater|half|full|complete|small|big|narrow|tight|wide|large|little)(?: of an?)?,? ({_CLOCK}) circles?\b",
     r"\1 circle \2"),
    (r"\b(?:an? )?(left|right)(?:wards?|[- ]sided) ((?:quarter |half |full )?circle)\b", r" \2 to the \1 "),
    (r"\b(\d+)[- ]?deg(?:ree)?s? (left|right)(?:wards?|[- ]sided|[- ]hand(?:ed)?)? (curve|bend|circle|arc)\b",
     r"\1 degree \3 to the \2"),
    (r"\b(curve|bend|arc|circle) of (?:about |approximately |around )?(\d+)[- ]?deg(?:ree)?s?\b", r"\2 degree \1"),
    (r"\bhalf (?:of )?an? round\b", "half circle"),
    (r"\b(walks?|walking|runs?|running|moves?|moving) circular(?:ly)?\b", r"\1 in a circle"),
    (r"\b(?:performs?|does|doing|makes) an? circular (walk|run)\b", r" \1 in a circle"),
    (r"\b(?:three|3)[- ](?:quarters?|fourths?)(?: of an?)? (?:turn|rotation|spin)\b", " 270 degree turn "),
    (r"\b((?:full|whole|complete|half|quarter)(?: of an?)?)(?<!with a half)(?<!with a full) turn\b(?! (?:kick|jump))", r" \1 turn turn "),
    # punches
    (rf"\b{_DOES} an? (?:(?:quick|fast|hard|short) )?(left|right)(?: (?:forwards?|straight|quick|hard))* (punch|jab|hook|uppercut)\b",
     r" punches once with the \1 hand \2 "),
    (rf"\b{_DOES} (?:(?:quick|fast|hard|short) )?(left|right)(?: (?:forwards?|straight|quick|hard))* (punch|jab|hook|uppercut)\b",
     r" punches with the \1 hand \2 "),
    (r"\b(left|right) kick\b", r" kick with the \1 leg "),
    (r"\b((?:kick|step|hop|stomp|stamp|lunge)[a-z]*(?: (?!start|begin|lead)[a-z]+){0,3}?) (?:with|using|on) (?:(?:his|her|its|their|the) )?(left|right)(?= *(?:$|[.,]|and\b|then\b))", r"\1 with the \2 leg"),
    (r"(?<!ing )(?<!starts )(?<!begins )\b(with|using) (?:(?:his|her|its|their|the) )?(left|right)(?= *(?:$|[.,]|and\b|then\b))", r"\1 the \2 hand"),
    # arms
    (rf"\bwith {_OWN}(left |right )?(?:arms?|hands?) (?:up )?in(?:to)? the air\b", r" while raising \1 hands "),
    (rf"\b{_HAVING}{_OWN}((?:left |right )?)(?:arms?|hands?) (?:is |are |being )*{_HELD} {_TO_SIDES}(?! and)(?: like wings)?",
     r" while arms_out \1 arms "),
    (rf"\b{_HAVING}{_OWN}((?:left |right )?)(?:arms?|hands?) (?:is |are |being )*{_HELD} {_AHEAD}\b",
     r" while arms_out \1 arms forwards "),
    (rf"\bopen(?:s|ing) (?:wide )?{_OWN}arms\b(?: wide(?:ly)?)?", " arms_out both arms "),
    (rf"\bstretch(?:es|ing) {_OWN}arms horizontal\b", " arms_out both arms "),
    (rf"\b(?:holds?|holding|keeps?|keeping|has|having) {_OWN}(left |right )?(arms?|hands?) (?:up )?in(?:to)? the air\b",
     r" raises \1 \2 "),
    (rf"\b(?:holds?|holding|keeps?|keeping) (?:up )?{_OWN}(left |right )?arms? (?:up )?(?:at|on|to) (?:the )?(?:height|level) of "
     rf"{_OWN}(?:shoulders?|chest)\b", r" arms_out \1 arms "),
    # the floor
    (r"(?<!arm )(?<!hand )\b((?:falls?|falling|lies|lying|collapses)\b[^.;]*?,? (?:and|then)) (?:stays?|remains?) (?:down|there)\b", r"\1 lies "),
    (r"\bup from the lying\b(?: (?:position|on the (?:ground|floor)))?", "up from lying"),
    (rf"\brais(?:es|ing) (?:up )?(?:on|to) {_OWN}knees\b", " kneels "),
    (r"\b(?:stay|remain)(?:s|ing) (?:(?:lying|laid)\b(?: there)?|(?:down )?on the (?:floor|ground))", " lies "),
)  # fmt: skip
