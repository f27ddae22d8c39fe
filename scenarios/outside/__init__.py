"""Ways for other programs and libraries to drive a bench: processes, environments of learning, linear systems."""


def register() -> None:
    """Register the environments in the namespace ``CombBench``; Gymnasium calls this by its entry point."""
    from gymnasium.envs.registration import register as add

    add("Tracking-v0", "scenarios.outside.environment:Tracking")
