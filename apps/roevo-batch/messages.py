"""What roevo-batch says."""

import sys
import time


class Fault(Exception):
    """Ends the program: exit code, and one line."""

    def __init__(self, text, code=1):
        super().__init__(text)
        self.code = code


def say(args, text):
    if not args.quiet:
        print(text, file=sys.stderr, flush=True)


class Progress:
    """A line that follows the work on a terminal, with the time left; one each 10 % in a log."""

    def __init__(self, args, total):
        self.total, self.shown = total, not args.quiet
        self.terminal, self.start, self.next = sys.stderr.isatty(), time.monotonic(), 0.1

    def update(self, done):
        share = done / self.total
        if not self.shown or not done or (share < self.next and not self.terminal):
            return
        left = (time.monotonic() - self.start) * (1 - share) / share
        time_left = f", about {left / 60:.0f} min left" if left > 90 else f", about {left:.0f} s left" if left > 0 else ""
        print(f"\r\033[K" * self.terminal + f"{done} of {self.total} rows{time_left}", end="" if self.terminal else "\n",
              file=sys.stderr, flush=True)
        self.next = share + 0.1

    def finish(self):
        if self.shown and self.terminal:
            print(file=sys.stderr)
