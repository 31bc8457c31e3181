"""The one error of a run that cannot start or go on."""


class RunError(RuntimeError):
    """What stopped the run, in one message for the user; nothing that was written is lost."""
