"""Printed reports: degrees of freedom, redundant constraints, computing cost, and advice on errors."""
