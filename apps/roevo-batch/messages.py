"""What roevo-batch says."""

import sys


class Fault(Exception):
    """Ends the program: exit code, and one line."""

    def __init__(self, text, code=1):
        super().__init__(text)
        self.code = code


def say(args, text, over=False):
    terminal = sys.stderr.isatty()
    if not args.quiet and (text or terminal):
        print(f"\r\033[K{text}" if terminal and over else text, end="" if terminal and over else "\n", file=sys.stderr,
              flush=True)
