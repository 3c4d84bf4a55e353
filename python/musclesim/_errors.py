"""The exceptions of musclesim. Each message names what is wrong, where, and what is allowed."""


class Error(Exception):
    """Base of all errors of musclesim."""


class BadParameter(Error, ValueError):
    """An argument, an option or a parameter that is not allowed."""


class BadFile(Error, ValueError):
    """A file that cannot be understood. `line` and `column` count from 1; 0 means the file as a whole."""

    file: str = ""
    line: int = 0
    column: int = 0


class Diverged(Error, ArithmeticError):
    """The simulation left the numbers of a physical system, at `time_s` (s) in the body, joint or muscle `where`."""

    time_s: float = 0.0
    where: str = ""


class IoError(Error, OSError):
    """Reading or writing failed for reasons outside the file's contents."""
