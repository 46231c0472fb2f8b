"""Skips a test where a package that it needs is not installed."""
import importlib
import sys


def need(*packages):
    for package in packages:
        try:
            importlib.import_module(package)
        except ImportError as error:
            print(f"skipped: {error}")
            sys.exit(77)
