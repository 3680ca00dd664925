"""Words and numbers of the trade, without loops: cutter, machine, posture, verdicts, nesting. May use: errors."""
