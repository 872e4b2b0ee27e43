"""Mechanisms outside Python: blocks of data and what reads them."""
