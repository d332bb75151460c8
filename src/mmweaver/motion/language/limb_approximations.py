"""Approximations of where hands and legs are put, and of gaits: (pattern, words acted out instead, how it is said)."""

_OWN = r"(?:(?:his|her|its|their|the|both|a|an|one|each) )*"
_SIDE = r"(?:left|right)"
_END = r"(?=$|[,.;]| and\b| then\b| while\b| before\b)"
_ON_BODY = (
    r"(?:knees?|thighs?|legs?|lap|chest|stomach|belly|waist|shoulders?|elbows?|body|feet|ankles?|arms?|sides?|neck)"
)

# Also where the sentence would be understood, but as something else.
INSTEAD_OF_ANOTHER: tuple[tuple[str, str, str], ...] = (
    (r"\b(?:spin|rotat|twirl)(?:s|es|ing) (?:it|them)\b(?: around)?", "stays", "how it is turned is not shown"),
    (r"\b(?:something|someone|somebody|an?other person|a force) (?:then )?(?:push|shov|bump|hit|knock)(?:es|s|ed|ing)?(?: into)? (?:them|him|her|it|the person)\b(?: over)?", "is pushed", "who or what pushes is not shown"),
    (rf",? with {_OWN}(?:shoulders?|hips?|head|chest|arms?|hands?|legs?|knees?|body) (?:[a-z]+ )?and (?:bounc|sway|swing|shak|wiggl|mov|danc|rotat|twist)ing\b", "", "how the body is held is not shown"),
    (r"\b(?:is )?(?:prepar(?:es|ing)|gets? ready|getting ready|about|readies (?:him|her|it)self) to [^,.;]*?(?=(?:,|;|\.|,? and|,? then|,? before)+ [a-z])", "stays", "what is only prepared is not shown"),
    (r"\bturn(?:s|ing) (?:an?|the|his|her) (?:[a-z]+ )?(?:knob|dial|handle|key|valve|screw|crank|faucet|tap)\b", "reaches for something", "is shown as reaching out with a hand"),
    (r"\b(?:spin|rotat|twirl)(?:s|es|ing) (?:an?|the|some) (?!full|half|whole|complete|quarter|few|couple|circle|left|right|lot|little|bit|upper|torso|trunk|head|body|hips|arms?|hands?|wrists?|legs?)[a-z]+\b", "stays", "what is spun is not shown"),
    (r"\bturn(?:s|ing)? (?:it|them|something|(?:an?|the|some) (?:[a-z]+ ){0,2}(?:objects?|items?|things?|box))\b(?: (?:over|around|upside down|upwards?))?", "stays", "how it is turned is not shown"),
    (r"(?:,? (?:and|then|before))* ?(?:return(?:s|ing)?|goes back|going back|comes back) to (?:an? |the |his |her |their )?(?:neutral|standing|normal|upright|rest(?:ing)?|natural|relaxed) ?(?:pose|stance|posture|position)?\b",
     ", then stands", "the pose at the end is shown as standing"),
    (rf"(?:,? (?:and|then))* ?bend(?:s|ing) (?:it|them)(?: at {_OWN}elbows?)?{_END}|\bbend(?:s|ing) {_OWN}(?:{_SIDE} )?(?:elbows?|arms?)\b", "", "how the arm is bent is not shown"),
    (rf"\bpull(?:s|ing)? (?:{_OWN}(?:{_SIDE} )?(?:hands?|arms?)|them|it) (?:back )?down{_END}", "stays", "arms that go down are shown as hanging"),
    (rf"\b(?:lift|rais)(?:s|es|ing) {_OWN}(?:{_SIDE} )?heels?\b(?: (?:off|from|up)[a-z ]*?)?{_END}", "stands", "raised heels are not shown"),
    (r"\b(?:does|do|doing|performs?|performing) (?:an? |some |\w+ )?(?:sit[- ]?ups?|crunch(?:es)?)\b", "sit-ups", ""),
    (rf"\bsits? up from (?:lying|{_OWN}(?:lying|floor|ground))[a-z ]*?{_END}", "gets up from the floor", "sitting up is shown as getting up from the floor"),
    (rf"(?:,? (?:and|then))* ?(?:(?:put|plac|rest|bring|hold|keep)(?:s|es|ing|ting)?) (?:{_OWN})({_SIDE} )?(?:hands?|arms?|palms?|elbows?) (?:on|to|onto|at|in|against) {_OWN}(?:{_SIDE} )?{_ON_BODY}\b",
     " stays", "hands put on the body are not shown"),
    (rf"\b(?:stretch|extend|straighten)(?:es|s|ing)? (?:out )?{_OWN}(?:{_SIDE} )?(?:legs?|foot|feet|knees?)\b(?: (?:out|straight))*(?! to the side| sideways| and)", "", "a leg that is stretched out is not shown"),
    (r"\b(?:(?:leans?|leaning) (?:forwards?|over)?) ?while sitting\b", "sits", "leaning while sitting is not shown"),
)  # fmt: skip

# Tried where a sentence is not understood.
WHERE_UNKNOWN: tuple[tuple[str, str, str], ...] = (
    (rf",? (?:with |and )?{_OWN}arms (?:are )?(?:swinging|swing)(?: (?:slightly|freely|gently|wildly|back and forth|at (?:his|her|their) sides?))*", "", "how the arms swing is not shown"),
    (rf"\blooks?{_END}", "looks around", "is shown as looking around"),
    (rf"\b(?:puts?|putting|extends?|extending|holds?|holding|sticks?) {_OWN}({_SIDE} )?(arms?|hands?)(?: and hands?)? (?:straight )?(?:out|forwards?)(?: in front(?: of (?:him|her|them|it)(?:self)?)?)?\b", r"puts the \1 \2 forward", "the arm is shown stretched forward"),
    (rf"\b(?:kneels?|bends?|gets?|drops?|goes)(?: down)? (?:on|onto|to) {_OWN}(?:all[- ]fours?|hands and knees)\b", "kneels down", "hands and knees are shown as kneeling"),
    (rf"\b(?:holds|is holding) (?:onto )?(?:something|an? (?!hand|arm)[a-z]+|the (?!hand|arm|left|right)[a-z]+)(?: up)?(?: (?:in|to|with|near) {_OWN}(?:{_SIDE} )?(?:hands?|face|head))?\b", "stays", "what is held is not shown"),
    (r"\bkick(?:s|ing)? (?:an? |the )?(?:soccer |foot)?ball\b", "kicks a ball", "is shown as a kick"),
    (rf"\b(?:is |gets? |getting |goes |going |drops? |comes? )(?:down )?(?:on|onto|to) {_OWN}(?:hands and knees|knees and hands)\b", "kneels down", "hands and knees are shown as kneeling"),
    (rf"\b(fall(?:s|ing)?(?: forwards?| down)?|collapses) (?:on|onto|to) {_OWN}(?:hands and knees|hands|knees and hands|face|stomach)\b", r"\1", "how the fall ends is not shown"),
    (rf"(?:,? (?:and|then|before))* ?(?:lower|drop)(?:s|ing)? {_OWN}(?:{_SIDE} )?(?:hands?|arms?|them|it)\b(?: (?:back|down|again|to (?:the|his|her|their|its) sides?))*", " stays", "arms that go down are shown as hanging"),
    (r"\b(?:slid(?:es|ing)|strafes?|strafing|scoot(?:s|ing)?|shuffles?|shuffling) ((?:over |quickly |slowly )?)(?=(?:to (?:the|his|her|their) )?(?:left|right|side))", r"sidesteps \1", "is shown as steps to the side"),
    (r"\bgallop(?:s|ing)?\b", "runs", "galloping is shown as running"),
    (r"\b(?:wobbl(?:es|ing)|sway(?:s|ing))\b", "staggers", "is shown as staggering"),
    (r"\bslip(?:s|ping)?\b", "stumbles", "is shown as stumbling"),
    (rf"\b(?:rolls?|rolling|cranes?) {_OWN}neck\b", "looks around", "is shown as looking around"),
    (r"\bdrag(?:s|ging) (?:something|an? [a-z]+|the [a-z]+)(?: backwards?)?\b", "pulls something", "dragging is shown as pulling on the spot"),
    (rf"\bblock(?:s|ing)?(?: (?:something|an? [a-z]+|with {_OWN}(?:{_SIDE} )?(?:arms?|hands?)))*", "hands_up", "a block is shown as hands held up"),
    (rf"\b(?:knees|kneeing) (?:the air|someone|forwards?|something)(?: with {_OWN}({_SIDE} )?(?:knee|leg))?", r"raises the \1 knee", "a knee strike is shown as a raised knee"),
    (r"\brow(?:s|ing)(?: (?:an? |the )?boat)?\b", "pulls something twice", "rowing is shown as pulling, standing"),
    (r"\bconduct(?:s|ing)(?: (?:an? |the )?(?:orchestra|band|music))?\b", "waves with both hands", "conducting is shown as waving"),
    (r"\bclimb(?:s|ing) (?:over|onto|on|up|down) (?:an? |the |some )?(?:[a-z]+ )?[a-z]+\b", "step_up_and_down", "climbing is shown as stepping up and down on the spot"),
    (rf"\b(?:swing|kick|dangl)(?:s|es|ing) {_OWN}(?:legs|feet)\b(?: (?:in the air|back and forth|around))*", "stays", "moving legs are not shown"),
    (rf"\blook(?:s|ing)? (?:back|behind|over)(?: (?:him|her|them|it)(?:self)?)?(?: over {_OWN}(?:{_SIDE} )?shoulder)?\b", "looks around", "a look back is shown as looking around"),
    (rf"\b(?:put|set|plac)(?:s|es|ing|ting) (?:it|them) (?:[a-z]+ly )?(?:back|down|away|aside|to (?:the|his|her|their) (?:left|right|side)){_END}", "reaches for something", "is shown as reaching out with a hand"),
    (r"\b(walk|run|jog|go)(s|es|ing|ning|ging)? around (?:an? |the |some )?(?:obstacle|object|thing|something|cone|person)s?\b", r"\1\2", "the way around it is not shown"),
    (r"\b(punch|kick)(es|s|ing)? (?:up|upwards?|down|downwards?)\b", r"\1\2", "how high it goes is not shown"),
    (r"\bwalk(s|ing)? (forwards? |backwards? )?(?:while |in a )?(?:crouching|crouched|crouch|squatting|bent over|hunched)(?: (?:down|position|over))?\b", r"walk\1 \2", "the bent back is not shown"),
    (rf"\bshak(?:es|ing) (?:someone|somebody|a person|another person)(?:'s| else's)? {_OWN}hands?\b", "shakes hands", "is shown without the other"),
)  # fmt: skip
