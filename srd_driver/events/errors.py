"""What is wrong with an event-driven system before it runs."""


class EventError(ValueError):
    """A system that cannot be simulated; the message names the parameter, its value and bound."""
