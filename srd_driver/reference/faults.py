"""What stops a simulation that went wrong."""


class SimulationFault(RuntimeError):
    """A state that no correct simulation reaches; the message names the particle, then the step."""
