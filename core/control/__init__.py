"""Controllers: all run all the time, one of them drives."""
