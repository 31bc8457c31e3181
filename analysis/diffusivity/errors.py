"""What a trajectory cannot tell."""


class DiffusivityError(ValueError):
    """Unusable parameters or too few data; the message names the value and what is needed."""
