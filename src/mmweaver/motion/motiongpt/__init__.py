"""MotionGPT: a sentence becomes motion by a language model whose words are also pieces of motion. Start at `model.py`.

Needs the extra `motiongpt` (transformers).
"""
