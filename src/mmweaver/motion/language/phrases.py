"""Phrases that mean one activity, angle or direction, replaced by one token before words are looked up."""

from mmweaver.motion.language.described_person import BUILDS, PERSON_NOUNS

_OWN = r"(?:his |her |its |their |the |both |own )*"
_BE = r"(?:is|are|was|were|be|been|being|beeing|gets?|got|getting|has been|having been)"
_LITTLE = (
    r"(?:slightly |strongly |hard |heavily |heavly |lightly |gently |suddenly |then |also |again |quickly |somehow )*"
)
_BODY = r"(?:person|man|woman|human|user|guy|girl|boy|subject|somebody|someone|figure|individual)"

# Replaced in this order, before lexicon.PHRASES: several words that mean one activity become one token.
ACTIVITY_PHRASES: tuple[tuple[str, str], ...] = (
    (rf"\b(?:{BUILDS})(?: and|,)? (?=(?:(?:{BUILDS}|old|young|elderly|tall|short|little) )*(?:{PERSON_NOUNS})\b)", ""),  # `described_person` has it
    (r"\b((?:drinks?|drinking|eats?|eating|reads?|reading|waves?|waving|claps?|clapping|types?|typing|writes?|phones?)(?: [a-z]+){0,4}?)"
     r" (?:while )?standing up\b", r"\1 while standing "),
    (r"\bcarr(?:y|ies|ied|ying) on(?: with)?\b(?! (?:an?|the|his|her|its|their|one|both)\b)", " continues "),
    (r"\bninety\b", " 90 "), (r"\bforty[- ]five\b", " 45 "), (r"\b(?:one |a )?hundred (?:and )?eighty\b", " 180 "),
    (r"\bform (?=(?:the |his |her )?(?:back|behind|front|left|right)\b)", " from "),
    (r"\b(?:a|an|one|two|three|four|five|some|few|\d+)(?: (?:few|short))? (?:steps?|seconds?|moments?|meters?|metres?) later\b",
     " then "),
    (r"\b(walks?|walking|runs?|running|goes|jogs?|jogging|paces?|strolls?) up and down\b(?! (?:the )?(?:stairs|steps))",
     r" \1 pacing_to_and_fro "),
    (r"\b(walks?|walking|runs?|running|goes) (?:a|one|in a) (?:small |big |full )?round\b", r" \1 in_circle "),
    (r"\bwith (?:his |her |its |their |the )backs? (?:turned |facing )?(?:to|towards?) the (radar|camera|sensor|viewer|device)\b",
     r" facing away from the \1 "),
    (r",? (?:and |but )?does(?: not|n't) get (?:back )?up(?: again)?\b", " "),  # true of who lies
    (r"\bnice and (?=big|large|wide|high|slow|slowly)", " "),
    (r"\bsteps? (?:to the )?front\b", " step forwards "), (r"\b(jumps?|leaps?|hops?) front\b", r" \1 forwards "),
    (r"\b(?:(?:in|along|on|through|by|following|making) )*(?:an? |the )?circular (?:path|shape|way|pattern|trajectory|line|motion|route"
     r"|movement|fashion|motions)\b", " in_circle "),
    (rf"\b(?:an? |the )?(standing|kneeling|sitting|seated|walking|running|jogging|lying) ({_BODY})\b", r" \2 \1 then "),
    (r"\b(?:standing|stands up|gets up|getting up|rises|rising|standing up|stand up|gets back up)"
     r"(?: up| back up)? (?:again )?(?:from|out of) (?:an? |the |his |her |its |their )?"
     r"(?:kneeling|knees?|kneel)(?: (?:position|pose|stance|posture))?\b", " kneel_up "),
    (rf"\b{_BE} {_LITTLE}(?:pushed|shoved|bumped|jostled|punched|hit|puched|pulled)\b", " pushed "),
    (r"\b(?:receives?|received|receiving|recovers? from|suffers?|reacts? to|recovering from|recover from|gets?|got|takes|taking)"
     r" (?:an? |the )?(?:very |strong |hard |slight |light |sudden |heavy |gentle |soft |little )*(?:push|shove|hit|kick|punch)\b", " pushed "),
    (r"\b(?:the|this) push(?:ing)?(?: force)?\b", " "),
    (r"\bto the (?:front|fore)\b", " forwards "),
    (r"\bto the back\b", " backwards "),
    (r"\bloses? (?:his |her |its |their |the )?balance\b|\bstumbling\b|\bstumbels?\b|\bstrumbles?\b",
     " stumbles "),
    (r"\b(left|right)[- ]hand(?:ed)? side\b", r" \1 side "),
    (r"\bas if (?:[a-z]+ +){0,5}pushed|\b(?:due to|because of|caused by|after|following) (?:an? |the )?(?:[a-z]+ )?(?:push|shove|hit)\b", " like "),
    (r"\bfrom (?:in )?front of (?:him|her|it|them|the person)\b|\bfrom in front\b|\bfrom the frontside\b", " from_front "),
    (r"\bfrom (?:the|one|a) side\b", " from_side "),
    (r"\bpushed +(?:a bit |slightly |a little )?backs\b", " pushed backwards "),
    (r"\bbow(?:s|ing|ed)? (?:his|her|its|their|the) head\b", " look_around lookdown "),
    (r"\b(bow(?:s|ing|ed)?(?: down| forwards?)?) (?:as if|like|to) greet(?:ing)? (?:someone|somebody|people|an? person)\b", r" \1 "),
    (r"\bupper[- ]?body\b|\btorso\b", " torso "),
    (r"\b(wav(?:es?|ing)(?: (?:his|her|its|their|the) (?:left |right )?(?:hands?|arms?))?) (?:from )?(?:left and right|right and left|"
     r"to the left and (?:to the )?right)\b", r" \1 "),
    (r"\bpick(?:s|ing|ed)? (?:up )?(?:an?|the|his|her|their)? ?(?:tea |coffee |water |mobile |smart|wine |cell )?(?:phone|cup|glass?|mug|bottle|"
     r"book|pen|remote|fork|spoon|plate|knife|key|keys|newspaper|magazine|tablet|bag|telephone)\b(?!(?: up)? (?:from|off)(?: of)? the (?:floor|ground))(?: up)?",
     " reach "),
    (r"\bfrom (?:his|her|its|their) (left|right)(?:[- ]hand)?(?: side)?\b", r" from_own_\1 "),
    (r"\bfrom (?:the |his |her |its |their )?(behind|back|rear|front|left|right)(?:[- ]?hand)?(?: ?side)?\b", r" from_\1 "),
    (r"\bby (?:pushing|supporting|using|leaning|pressing)\b[^,.;]*", " "),
    (r"\b(?:up|down|onto|over|on) (?:an?|the|one) (?:small |high |little )?(?:step|stair|platform|curb)\b", " stairs "),
    (rf"\b(?:rais(?:es|ing|ed?)|lift(?:s|ing)?) {_OWN}(?:left |right )?(arms?|hands?) (?:up )?to (?:the )?(?:height|level) of "
     rf"{_OWN}(?:shoulders?|chest)\b", r" arms_out \1 "),
    (r"\bin (?:the |his |her |its |their )back\b", " from_back "),
    (r"\bon (?:his |her |its |their )(left|right) (?:hand )?(?:shoulder|side|arm|hip)\b(?!.*\bto (?:the|its) (?:left|right))",
     r" on_own_\1_side "),
    (r"\bon (?:the |his |her |its |their )(left|right) (?:hand )?(?:side|shoulder)\b", r" on_\1_side "),
    (r"\b(?:goes|gets|going|getting|go|get|falls|drops|sinks|moves|drop|fall|sits|descends)(?: down)?(?: slowly)?"
     rf" (?:down )?(?:on|onto|to|in|into) {_OWN}(?:one |his left |his right |left |right )?knees?\b", " kneel_down "),
    (rf"\b(?:steps?|stepping|walks?|comes?|lands?) (?:down )?(?:on|onto) {_OWN}(?:two |both )?knees\b", " kneel_down "),
    (r"\bkneels? (?:down|on|onto)\b|\bkneeling down\b|\bknees (?:down|on)\b|\bknelt(?: down)?\b|\bsits on (?:his|her) heels\b",
     " kneel_down "),
    (r"\b(?:is |are )(?:kneeling|on (?:his|her|its|their) knees)\b", " kneeling "),
    (r"\b(?:lies?|lays?|lying|laying|lie|layed|lays himself|lays itself) (?:itself |himself |herself )?down\b",
     " lie_down "),
    (r"\b(?:on|onto) (?:his|her|its|their|the) (?:back)\b", " onback "),
    (r"\b(?:on|onto) (?:his|her|its|their|the) (?:belly|stomach|tummy|front|chest|face)\b|\bface down\b", " onbelly "),
    (r"\b(?:stands?|gets?|getting|standing|rises?|rising)(?: back)? up from (?:lying|laying|lie)\b([^,.;]*)", r" get_up \1 "),
    (r"\b(?:stands?|gets?|getting|standing|rises?|rising)(?: back)? up (?:from|off(?: of)?) (?:the |lying on the )?(?:floor|ground)\b"
     r"|\b(?:gets?|getting|stands?|standing|rises?)(?: back)? up (?:again )?(?:after|from) (?:lying|a fall)\b",
     " get_up "),
    (r"\b(?:falls?|falling|fell|collapses?|drops?) (?:down |over |backwards? |forwards? )*(?:on|onto|to) (?:the )?"
     r"(?:floor|ground)\b", " falls "),
    (r"\b(?:falls?|falling|fell) (?:over|down)\b", " falls "),
    (r"\b(?:takes?|taking|makes?|making|does|performs?|gives?) (?:an? |the |his |her )?(?:deep |small |slight |polite |"
     r"short |quick |slow |gentle )*bow\b", " bows "),
    (r"\bbow(?:s|ed|ing)? (?:down|forwards?)\b", " bows "),
    (r"\bbend(?:s|ed|ing)?(?: himself| herself| itself)? (?:down|over|forwards?|downwards?)(?: (?:over|down|forwards?))?\b",
     " bends "),
    (r"\b(?:leans?|leaning|leaned) (?:far )?(?:down|forwards?|over)\b(?! (?:to|on|against|left|right|sideways))", " bends "),
    (r"\b(pick|lift|take|grab|get(?!(?:s|ting)?(?: back)? up\b)|raise|collect)(s|ing|ed)? (?!up (?:his|her|its|their|the|both|a|an|one|left|right)? ?"
     r"(?:arms?|hands?|legs?|foot|feet|knees?))(?:up )?(?:(?!up\b|then\b|and\b|while\b)[a-z]+ ){0,4}(?:up )?(?:from|off|of) "
     r"(?:of )?(?:the )?(?:floor|ground)\b", " pick_up "),
    (r"\bpick(s|ing|ed)? up\b|\bpick(s|ing|ed)? (?:(?:an?|the|his|her|its|something|some|it|box|ball|object|thing|and)"
     r" ?){1,3}up\b|\bpicks? up and object\b", " pick_up "),
    (r"\b(?:puts?|putting|places?|placing|lays?|sets?|setting|drops?) (?:(?:an?|the|his|her|its|their|something|it|box|ball|"
     r"object|thing|item|glass|cup|phone|bottle|book|some|back) ){1,4}(?:back )?(?:down\b(?! (?:on|onto|in|into|under|next to) (?!(?:the )?(?:floor|ground)\b))"
     r"|(?:on|onto|to) the (?:floor|ground)\b)"
     r"|\b(?:puts?|places?|sets?) down (?:an?|the|something|it)\b", " put_down "),
    (r"\b(?:takes?|grabs?|taking|grabbing) (?:(?:an?|the|his|her|something|cup|glass|book|bottle|it) ){1,3}(?:from|off) "
     r"(?:the |a )?(?:table|desk|shelf|counter|cupboard)\b", " reach "),
    (r"\b(?:plays?|playing|play|pretends? to play|practices?|strums?)(?: on)?(?: an?| the| some| his| her| its)?"
     r"(?: air| small| imaginary| acoustic| electric| big| virtual)*[- ]?(?:guitar|banjo|ukulele|ukelele|bass|lute)\b",
     " play_guitar "),
    (r"\bplays? (?:an? |the )?air[- ]?guitar\b", " play_guitar "),
    (r"\bplay(?:s|ing)? (?:some |a few |an? |the |several )?(?:[a-z]+ )?(?:chords?|songs?|melod(?:y|ies)|tunes?|notes?|music|solos?) (?:on|with) (?:an? |the |his |her )?"
     r"(?:[a-z]+ )?(guitar|violin)\b", r" play_\1 "),
    (r"\b(?:plays?|playing|play|pretends? to play|practices?)(?: on)?(?: an?| the| some| his| her| its)?"
     r"(?: air| small| imaginary)*[- ]?(?:violin|fiddle|viola)\b", " play_violin "),
    (r"\b(?:plays?|playing|play)(?: some)? golf\b|\b(?:golf|drive)[- ](?:swing|strike|stroke|drive|hit|shot)s?\b"
     r"|\bgolf(?:ing|s)\b|\bswings? (?:an? |the |his |her )?golf[- ]club\b|\bswinging (?:an? |the |his )?golf[- ]club\b",
     " play_golf "),
    (r"\b(?:brush(?:es|ing|ed)?|clean(?:s|ing)?) (?:his|her|its|their|the|my) teeth\b", " brush_teeth "),
    (r"\b(?:comb(?:s|ing|ed)?|brush(?:es|ing|ed)?|does|straighten(?:s|ing)?) (?:his|her|its|their|the) hair\b",
     " comb_hair "),
    (r"\b(?:talk(?:s|ing)?|speak(?:s|ing)?|chat(?:s|ting)?|is|calls? (?:someone|somebody)|calling|answer(?:s|ing)?)"
     r"(?: someone)? (?:on|into|over|by)? ?(?:the |a |his |her |their )?(?:mobile |cell |smart)?-?(?:phone|telephone|call"
     r"|cellphone|smartphone)\b"
     r"|\b(?:makes?|making|takes?|taking|has|having|answers?) (?:an? |the )?(?:phone )?call\b|\bphone call\b", " phone "),
    (r"\b(?:look(?:s|ing)?|stare(?:s|ing)?|scroll(?:s|ing)?|text(?:s|ing)?|typ(?:es|ing)|us(?:es|ing)|check(?:s|ing)?|"
     r"play(?:s|ing)?)(?: a message| messages| text)? (?:at |on |through |with |into )?(?:the |a |his |her |their )?"
     r"(?:mobile |cell |smart)?-?(?:phone|cellphone|smartphone|tablet)\b", " text "),
    (r"\b(?:us(?:es|ing)|work(?:s|ing)? (?:on|at|with)) (?:the |a |his |her |their )?"
     r"(?:laptop|computer|keyboard|pc)\b", " types "),
    (r"\bopen(?:s|ing|ed)? (?:the |a |an |his |her )?(?:front |room |cupboard |fridge |wardrobe )?"
     r"(?:door|fridge|cupboard|window|drawer|wardrobe)\b", " open_door "),
    (r"\b(is (?!standing|sitting)[a-z]+ing(?: [a-z]+)?) and looking (?:all )?a(?:round|bout)\b", r" \1 while look_around "),
    (r"\bthan (?=(?:back|forward|turn|walk|run|sit|stand|stop|jump)[a-z]*\b)", " then "),
    (r"\bshak(?:es?|ing) (?:his|her|its|their|the) head\b", " shake_head "),
    (r"\bnod(?:s|ding|ded)? (?:with )?(?:his|her|its|their|the) head\b", " nods "),
    (r"\blook(?:s|ing|ed)? (?:all )?a(?:round|bout)\b|\bturn(?:s|ing)? (?:his|her|its|their|the) head\b", " look_around "),
    (r"\blook(?:s|ing|ed)? (?:to )?(?:the |his |her |its )?(left|right)\b", r" look_around \1 "),
    (r"\b(?:while |and )?look(?:s|ing|ed)? (?:straight )?(?:down|at the (?:ground|floor)|at (?:his|her|its|their) (?:feet|"
     r"foot|shoes)|to the (?:ground|floor))\b", " while look_around lookdown "),
    (r"(?<=[a-z]),? (?:with )?(?:his |her |their |the )?arms (?:crossed|folded)(?: (?:across|over|in front of|on) (?:the|his|her|their) chest)?"
     r"(?= *(?:$|[,.;]))", " while cross_arms "),
    (r"\b(?:cross(?:es|ing|ed)?|folds?|folding|folded) (?:his |her |its |their |the |both )*arms\b"
     r"|\b(?:with |has )(?:(?:his|her|its|their) )?(?:crossed|folded) arms\b|\barms (?:are )?(?:crossed|folded)\b",
     " cross_arms "),
    (r"\b(?:with |puts? |putting |places? |has |having )?(?:his |her |its |their |the |both )*(?:hands|arms)(?: are)? "
     r"(?:on|onto|at|to|in) (?:his |her |its |their |the )*(?:hips?|waist)\b", " hands_on_hips "),
    (r"\b(?:with |puts? |putting |places? |has |having |holds? |holding |rests? )(?:his |her |its |their |the |one |a )*(left |right )?(?:hand|arm) "
     r"(?:on|onto|at) (?:his |her |its |their |the )*(?:left |right )?(?:hips?|waist)\b", r" hands_on_hips one \1 hand "),
    (r"\b(?:holds?|holding|puts?|putting|has|having) (?:a |the |his |her |their )?(?:mobile |cell |smart)?-?(?:phone|telephone)"
     r" (?:to|at|against|on) (?:his |her |the |their )?(?:left |right )?ear\b", " phone "),
    (r"\bshrug(?:s|ging|ged)?(?: with)?(?: his| her| its| their| the)? shoulders\b", " shrugs "),
    (r"\b(?:rais(?:es|ing|ed?)|lift(?:s|ing|ed)?) ((?:his |her |its |their |the |both )*arms) (?:up )?"
     r"(?:to (?:do |form |make |strike )?|into |in )(?:an? )?t-? ?pose\b", r" arms_out \1 "),
    (r"\b(?:in(?:to)? )?(?:an? )?t-? ?poses?\b", " arms_out "),
    (r"\b(?:stretch(?:es|ing|ed)?|hold(?:s|ing)?|spread(?:s|ing)?|extend(?:s|ing|ed)?|rais(?:es|ing|ed?)|lift(?:s|ing)?)"
     r" (?:out )?((?:his |her |its |their |the |both |left |right |one )*(?:arms?|hands?)) (?:out )?(?:horizontally )?"
     r"(?:to (?:the|his|her|its|their|both) sides?|sideways|sidewards|horizontally|to (?:the |his |her |its |their )?"
     r"shoulders?(?: height| level)?|out|outwards?|apart|to a t-pose)\b", r" arms_out \1 "),
    (r"\b(?:stretch(?:es|ing|ed)?|hold(?:s|ing)?|extend(?:s|ing|ed)?|rais(?:es|ing|ed?)|lift(?:s|ing)?|puts?)"
     r" (?:out )?((?:his |her |its |their |the |both |left |right |one )*(?:arms?|hands?)) (?:straight |out )*"
     r"(?:forwards?|ahead|to the front|in front of (?:him|her|it|them|his body|her body|the body|himself|itself))\b",
     r" arms_out \1 forwards "),
    (r"\bwith (?:(?:his|her|its|their|both|the) )*(?:arms?|hands?) (?:stretched|spread|extended|held|outstretched)"
     r"(?: out)?\b(?! (?:up|over|above|forward|forwards|in|ahead|behind|low|high|down|together))"
     r"(?: (?:to (?:the|both|his|her) sides?|sideways|wide|horizontally))?", " while arms_out "),
    (r"\bwith (?:(?:his|her|its|their|both|the) )*(?:arms?|hands?) (?:raised|lifted|held up) (?:to (?:the|both|his|her|their) sides?|"
     r"sideways|horizontally)\b", " while arms_out "),
    (rf"\b(?:rises|rise|rising|rose) (?:to (?=hands? up))?(?=(?:up )?{_OWN}(?:left |right )?(?:arms?|hands?|legs?|foot|feet|knees?)\b)", " raises "),
    (r"\bdrunk (?=person|man|woman|human|guy|people|way|manner)|\b(?:seems? |looks? |is |being |like )drunk(?:en)?\b", " drunken "),
    (r"\bstretch(?:es|ing|ed)? (?:out )?(?:himself|herself|itself|his body|her body|his back|her back|the body)\b",
     " stretches "),
    (r"\b(?:circl(?:es|ing)|rotat(?:es|ing)|swing(?:s|ing)?|windmill(?:s|ing)?) (?:with )?"
     r"(?:(?:his|her|its|their|the|both|left|right) )*arms? (?:in (?:big |large |small |full )?circles|around|round|"
     r"in a circle)\b|\barm circles\b|\bcircl(?:es|ing) (?:(?:his|her|its|their|the|both) )*arms\b", " circle_arms "),
    (r"\b(?:while |and |with )?(?:also )?(?:casually |slightly |loosely |normally )?"
     r"swing(?:ing|s) (?:his |her |its |their |the |both )*(?:bent )?arms(?= *(?:[,.;]|$|while))"
     r"|\bwith (?:(?:his|her|its|their|the) )?(?:casually |slightly )?swinging arms\b"
     r"|\bwith the arms swinging(?: a little bit)?\b", " "),
    (r"\b(?:stand(?:s|ing)?|balanc(?:es|ing)|stay(?:s|ing)?|is)(?: still)? (?:only )?(?:himself |itself |herself )?on "
     r"(?:only )?(?:one|a single|the|his|her|its|their) ?(left|right)? (?:leg|foot)\b", r" one_leg_stand \1 leg "),
    (r"\b(left|right) (?:leg|foot|feet|food|knee)\b", r" \1_leg "),
    (r"\bside ?-?step(?:s|ping|ped)?\b|\bsitesteps?\b", " sidestep "),
    (r"\bafter (?:(?:a|an|one|two|three|four|five|six|some|few|couple|of|several|\d+|the|first|second|short|small) )+"
     r"(?:steps?|meters?|metres?|while|moment|seconds?|time|distance)\b", " then "),
    (r"\((left|right) (?:turn|curve|bend|circle)\)", r" to the \1 "),
    (r"\baround an? (left|right) corner\b", r" arc90 to the \1 "),
    (r"\b(?:one |a )?third of (?:an? |the )?circle\b", " arc120 "),
    (r"\b(90|180|270|360)\b(?= (?:turn|jump|spin|clockwise|counter|left|right|rotation))", r"\1 degrees "),
    (r"\bside-? ?kick(s|ing)?\b|\bkick(?:s|ing|ed)? (?:to the )?side(?:ways)?\b", " kicks sideways "),
    (r"\bhigh[- ]kick(s|ing)?\b|\bkick(?:s|ing|ed) (?:(?:really |very )?high|high up)\b", " highkick kicks "),
    (r"\bduck(?:s|ing|ed)? (?:down|away)?\b", " duck_down "),
    (r"\bu-? ?turn\b", " arc180 "),
    (r"\bthrow(?:s|ing)? an? (?:(?:quick|fast|hard|strong|straight|single|powerful) )*((?:left |right )?(?:punch|jab|hook|uppercut))\b(?! (?:and|or|after)\b)", r" punches once \1 "),
    (r"\bthrow(?:s|ing)? (?:(?:a|some|few|several|two|three|quick|fast|hard) )*((?:left |right )?(?:punch|punches|jabs?|hooks?|uppercuts?))\b",
     r" punches \1 "),
    (r"\b(?:in the air|in mid-?air)(?= *(?:[.,]|$))", " mid-air "),
    (r"\bsome one\b", " someone "),
    (r"\ba quarter\b(?! ?-?(?:circle|turn|of|ride|cir))", " arc90 "),
    (r"\b(\d+) ?/ ?(\d+)(?:th)? (?:of )?(?:an? |the )?circle\b", r" fraction_\1_\2 "),
    (r"\b(?:three|3)[- ](?:quarters?|fourths?|quater) (?:of )?(?:an? |the )?circle\b", " arc270 "),
    (r"\bthree fourth of a circle\b", " arc270 "),
    (r"\b(?:quarter|quater|quarters|fourth)[- ]?(?:of )?(?:an? |the )?(?:(left|right)[- ]?sided |ride[- ]?sided |in )?circles?\b",
     r" arc90 to the \1 "),
    (r"\b(?:half|semi)[- ]?(?:of )?(?:an? |the )?(?:in )?-?circles?\b|\bsemi-?circles?\b", " arc180 "),
    (r"\b(\d+)[- ]?(?:degrees?|degress|degree|deg|°|degres) (?:of an? |of the |in an? )?"
     r"(?:sharp )?((?:left|right)?)(?:wards?)? ?(?:circle|curve|bend|arc|turn in a curve)\b", r" arc\1 to the \2 "),
    (r"\b(\d+)[- ]?(?:degrees?|degress|deg|°|degres)\b", r" deg\1 "),
    (r"\bquarter(?: of an?)? turn\b", " deg90 "),
    (r"\b(?:half|halve)(?: a)? turn\b", " deg180 "),
    (r"\b(?:full|complete|whole) (?:turn|spin|rotation)\b", " deg360 "),
    (r"\b(walks?|walking|goes|going|runs?|running|moves?|moving|jogs?|jogging) (?:slowly |quickly )?(?:in |along |with |through )?(?:an? |the )? *"
     r"(?:(?:slow|slowly|fast|sharp|wide|tight|slight|small|big|normal|a) )* ?deg(\d+) +(?:turn|bend|corner)\b", r" \1 arc\2 "),
    (r"\b(walks?|walking|goes|going|runs?|running|moves?|moving|jogs?|jogging) (?:in |along |with |through )?(?:an? |the )?"
     r"(?:(?:slow|fast|sharp|wide|tight|slight|small|big|normal) )*(left|right)[- ](?:hand )?(?:turn|bend|corner|curve|arc)\b",
     r" \1 arc90 to the \2 "),
    (r"\b(walks?|walking|goes|going|runs?|running|moves?|moving) (?:in|along|through|with) an? (?:(?:slow|fast|sharp|wide|tight|"
     r"slight|small|big|normal) )*(?:turn|corner)\b", r" \1 arc90 "),
    (r"\baround (?:an?|the) corner\b", " arc90 "),
    (r"\b(?:in |along |around |a |an |slight |wide |sharp |big |long |light |small |tight )*(?:curve|arc|bend)\b"
     r"(?! (?:down|over|forward|posture|position|pose|stance|manner|way|legs?|knees?))", " arc60 "),
    (r"\b(?:counter|anti)[- ]*(?:clock|clook)[- ]?wise\b|\bcounter clock wise\b", " to the left "),
    (r"\bclock[- ]?wise\b", " to the right "),
    (r"\bback to (?:the |his |her |its |their )?(?:start(?:ing)?|initial|original|first|old)"
     r"[a-z]*(?: (?!and\b|then\b|before\b|after\b|while\b|but\b)[a-z]+)*\b", " back_to_start "),
    (r"\b(?:back )?to (?:the (?:place|spot|point|position) )?where (?:he|she|it|they|the person) (?:came from|started|began|was(?: before)?|stood(?: before)?)\b",
     " back_to_start "),
    (r"\bto (?:the|his|her|its) (?:original |starting |initial |start )(?:standing )?(?:position|point|place|spot)\b", " back_to_start "),
)  # fmt: skip
