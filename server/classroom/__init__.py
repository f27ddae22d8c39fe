"""Classes: people and their rights, lessons, sheets, votes, games, hidden faults, grades, learning platforms."""
