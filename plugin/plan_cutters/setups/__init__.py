"""How the part stands and what holds it: setups as callers and files give them, vises and chucks and where they may stand."""
