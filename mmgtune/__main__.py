"""``python -m mmgtune``."""

from .cli import main

if __name__ == "__main__":
    main()
