"""Faults: what they change, how severity enters, where they show."""
