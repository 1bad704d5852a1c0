"""
Proofs about the integer arithmetic of a generated library, for every input at once.

What is proven is what avr-gcc compiles: it is asked for its own intermediate form (GIMPLE) of the
generated source, with the chip's types and each conversion written out (`gimple`). All ways
through each function are followed with values of which nothing is known but an invariant
(`machine`), and z3 shows that no operation loses a bit unless a table says that it is meant
(`meant`), that the invariant holds again at the end, and that the results are what the reference
model computes with integers that do not end (`claims_*`).
"""
