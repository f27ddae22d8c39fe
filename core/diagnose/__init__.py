"""Diagnosis: which hypothesis the measurements speak for."""
