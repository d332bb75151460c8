"""Independent checks of a plan against its sentence: multiplicity, order, repetition, endings and things.

`coverage`, `mentions` and `accounts` ask of each word whether a step has it. Here what the sentence says is read as
sequences, and compared with the steps as sequences: a word that another mention has used up is not shown twice.
"""
