"""What a command said and left: one line, the words of a text, the files of a folder."""


def assert_one_line(done, code, *words):
    assert done.returncode == code, done.stderr
    assert done.stdout == ""
    lines = done.stderr.strip().splitlines()
    message = lines[-1]
    assert message.startswith("plan-cutters: ")
    for word in words:
        assert word in message
    assert "Traceback" not in done.stderr
    return message


def in_lines(text):
    """What was said, whatever the lines that it was set in."""
    return " ".join(text.split())


def said_until(process, word):
    """Lines of a running command up to the one with a word."""
    for line in process.stderr:
        if word in line:
            return
    raise AssertionError(f"it ended without {word!r}")


def leftovers(folder, *known):
    return sorted(p.name for p in folder.iterdir() if p.name not in known)
