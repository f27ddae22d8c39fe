"""Any bench without its controllers as a functional mock-up unit (FMU), native code for other simulators."""
