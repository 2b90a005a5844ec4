"""Parameter files: each line is NAME,VALUE, and `#` begins a comment."""

from .link import GroundError


def text(parameters):
    # Nine digits hold every 32-bit float.
    return "".join(f"{name},{value:.9g}\n" for name, value in parameters.items())


def values(content):
    """Reads names and values. Blanks may stand in place of the comma."""
    found = []
    for number, line in enumerate(content.splitlines(), 1):
        words = line.split("#")[0].replace(",", " ").split()
        if not words:
            continue
        try:
            name, value = words
            found.append((name, float(value)))
        except ValueError:
            raise GroundError(f"line {number}: `{line}` is not NAME,VALUE") from None
    return found
