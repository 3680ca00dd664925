"""Plans that are out of date lose their colours: when a document was computed, at an undo, and when one is opened."""

from __future__ import annotations

import json

import FreeCAD as App

from . import host, objects
from .words import tr


class Watch:
    """An observer of documents (`App.addDocumentObserver`)."""

    def __init__(self) -> None:
        self._seen: dict[tuple[str, str], tuple] = {}
        self._busy = False

    def slotRecomputedDocument(self, document) -> None:
        # Links may lead from another document to this one.
        for each in App.listDocuments().values():
            self.check(each)

    def slotUndoDocument(self, document) -> None:
        self.check(document)

    def slotRedoDocument(self, document) -> None:
        self.check(document)

    def slotFinishRestoreDocument(self, document) -> None:
        if host.has_window():
            objects.repaint(document)
        self.check(document)

    def check(self, document) -> None:
        """Drop the colours of plans whose bodies are no longer as they were planned."""
        if self._busy:
            return
        self._busy = True
        try:
            for group in objects.plans(document):
                if not group.OutOfDate and self._moved(group):
                    why = objects.stale(group)
                    if why:
                        objects.drop(group, why)
        except Exception as error:  # an observer that raises would stop the others
            host.warn(tr("whether plans are up to date is not known: {error}").format(error=error))
        finally:
            self._busy = False

    def _moved(self, group) -> bool:
        """Whether shapes may be others than at the last look: kernel handles and places alone, which costs nothing."""
        key, now = (group.Document.Name, group.Name), []
        for name in json.loads(getattr(group, objects.JOB))["fingerprints"]:
            thing = group.Document.getObject(name)
            if thing is not None:
                shape = host.plain_shape(thing)
                now += [name, shape.isNull() or shape.hashCode(), str(host.container_placement(thing))]
        moved, self._seen[key] = self._seen.get(key) != tuple(now), tuple(now)
        return moved


_watch: Watch | None = None


def start() -> None:
    """Begin to watch; once."""
    global _watch
    if _watch is None:
        _watch = Watch()
        App.addDocumentObserver(_watch)
