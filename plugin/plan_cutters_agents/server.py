"""The server: calls of the protocol become calls of the tools, and what goes wrong becomes one line."""

import base64
import json
import logging
import signal
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import anyio.to_thread
from pydantic import ValidationError

from plan_cutters import __version__
from plan_cutters.errors import PlanError
from plan_cutters.files.lock import require_temporary
from plan_cutters_agents.access import CallError, Limits, Permissions, Roots
from plan_cutters_agents.child import Call
from plan_cutters_agents.requests import PlanQuestion
from plan_cutters_agents.short import answer_schema, question_schema
from plan_cutters_agents.tools import TOOLS, Reply, Tool, fitting

if TYPE_CHECKING:
    import mcp.types as types
    from mcp.server.lowlevel import Server

_INSTRUCTIONS = (
    "plan-cutters says which milling cutters can finish the surfaces of a CAD part without gouging or collision, before any "
    "toolpath exists. Lengths are mm, angles degrees, shares of an area 0 to 1. `undecided` is an answer: neither proved safe "
    "nor proved blocked, so never safe. To ask why a cutter does not reach a face and what would help, use explain_sample: one "
    "call answers both. Fields of a question without a description are those of plan_part. A list that was cut says how much it "
    "leaves out."
)
#: Media types of written files, by suffix.
_MEDIA = {".json": "application/json", ".html": "text/html", ".png": "image/png", ".step": "model/step", ".csv": "text/csv",
          ".glb": "model/gltf-binary", ".toml": "application/toml"}  # fmt: skip
#: Name of the request for the client's roots, where it is part of an answer.
_ROOTS = "roots"


class Service:
    """Answers calls within roots and limits; `client_roots`: folders that the client offers are roots as well."""

    def __init__(self, roots: Roots, limits: Limits, *, client_roots: bool) -> None:
        self.roots, self.limits, self.client_roots = roots, limits, client_roots
        self._turns: anyio.CapacityLimiter | None = None
        self._working: set[anyio.CancelScope] = set()

    async def list_tools(self, context: Any, params: Any) -> "types.ListToolsResult":
        import mcp.types as types

        return types.ListToolsResult(
            tools=[
                types.Tool(
                    name=tool.name, title=tool.title, description=tool.description,
                    input_schema=question_schema(tool.question, PlanQuestion), output_schema=answer_schema(tool.answer),
                    annotations=types.ToolAnnotations(read_only_hint=not tool.writes, destructive_hint=tool.writes,
                                                      idempotent_hint=True, open_world_hint=False),
                )
                for tool in TOOLS
            ]
        )  # fmt: skip

    async def call_tool(self, context: Any, params: "types.CallToolRequestParams") -> Any:
        import mcp.types as types

        try:
            tool = next((each for each in TOOLS if each.name == params.name), None)
            if tool is None:
                raise CallError(f"there is no tool {params.name!r}; there are {', '.join(each.name for each in TOOLS)}")
            question = _question(tool, params.arguments or {})
            roots = await self._roots(context, params)
            if not isinstance(roots, Roots):
                return roots
            with anyio.CancelScope() as scope:
                self._working.add(scope)
                try:
                    reply = await self._answered(tool, question, roots, context)
                finally:
                    self._working.discard(scope)
            if scope.cancelled_caught:
                raise CallError("the server was ended")
            answer = await anyio.to_thread.run_sync(fitting, reply.answer, self.limits.most_characters)
        except Exception as error:
            match error:
                case PlanError():
                    line = str(error)
                case TimeoutError():
                    line = (
                        f"no answer within {self.limits.timeout:g} s: sample more coarsely, choose fewer faces or "
                        "cutters, or start the server with a longer --timeout"
                    )
                case _:
                    logging.getLogger(__name__).debug("internal error", exc_info=True)
                    line = f"internal error ({type(error).__name__}: {error})"
            return types.CallToolResult(content=[types.TextContent(text=" ".join(line.split())[:2000])], is_error=True)
        content: list[Any] = [types.TextContent(text=json.dumps(answer, ensure_ascii=False))]
        if reply.picture is not None:
            content.append(types.ImageContent(data=base64.b64encode(reply.picture).decode(), mime_type="image/png"))
        # For clients that open files themselves.
        content += [
            types.ResourceLink(
                name=file.name, uri=file.absolute().as_uri(), description=what,
                mime_type=_MEDIA.get(file.suffix.lower(), "application/octet-stream"),
                size=file.stat().st_size if file.is_file() else None,
            )
            for what, file in ((what, Path(name)) for what, name in reply.files.items())
        ]  # fmt: skip
        return types.CallToolResult(content=content, structured_content=answer)

    async def end(self) -> None:
        """Cancel all calls, and wait until nothing of them is left."""
        for scope in tuple(self._working):
            scope.cancel()
        while self._working:
            await anyio.sleep(0.02)

    async def _answered(self, tool: Tool, question: Any, roots: Roots, context: Any) -> Reply:
        if self._turns is None:
            self._turns = anyio.CapacityLimiter(self.limits.calls)
        shown = 0.0

        async def tell(seconds: float, words: str, rest: float | None = None) -> None:
            # Several processes may work on one call: what is told grows all the same.
            nonlocal shown
            shown = max(seconds, shown + 0.001)
            await context.session.report_progress(shown, None if rest is None else shown + rest, words)

        with anyio.fail_after(self.limits.timeout):
            async with self._turns:
                require_temporary()
                with tempfile.TemporaryDirectory(prefix="plan-cutters-mcp-") as folder:
                    return await tool.work(question, Call(Permissions(roots, self.limits), Path(folder).resolve(), tell))

    async def _roots(self, context: Any, params: "types.CallToolRequestParams") -> Any:
        """The roots of this call; where the client is to be asked for its own in an answer, that answer."""
        import mcp.types as types
        from mcp.shared.exceptions import MCPError

        able = context.session.client_capabilities
        if not self.client_roots or able is None or able.roots is None:
            return self.roots
        try:
            if context.session.can_send_request:
                reply = await context.session.send_request(types.ListRootsRequest(), types.ListRootsResult, 10.0)
            else:
                reply = (params.input_responses or {}).get(_ROOTS)
                if reply is None:
                    return types.InputRequiredResult(input_requests={_ROOTS: types.ListRootsRequest()})
        except MCPError:
            return self.roots  # it offers none after all
        uris = [str(each.uri) for each in getattr(reply, "roots", ())]
        return self.roots | Roots.of_client(uris)


def _question(tool: Tool, arguments: dict[str, Any]) -> Any:
    """The question as its model has it; a CallError with the first thing that is wrong, and how many more there are."""
    try:
        return tool.question.model_validate(arguments)
    except ValidationError as error:
        faults = error.errors()
        place = ".".join(map(str, faults[0]["loc"]))
        more = f" (and {len(faults) - 1} more)" if len(faults) > 1 else ""
        raise CallError(f"{place + ': ' if place else ''}{faults[0]['msg'].removeprefix('Value error, ')}{more}") from None


def service_of(folders: Sequence[str], limits: Limits, *, client_roots: bool) -> Service:
    """The service of some roots; a CallError where one is no folder."""
    return Service(Roots.of(folders), limits, client_roots=client_roots or not folders)


def made(service: Service) -> "Server[Any]":
    """The server of a service."""
    from mcp.server.lowlevel import Server

    return Server(
        "plan-cutters",
        version=__version__,
        instructions=_INSTRUCTIONS,
        on_list_tools=service.list_tools,
        on_call_tool=service.call_tool,
    )


def serve(service: Service, interrupted: Callable[[], None]) -> None:
    """Serve over standard input and output until the client closes them.

    `interrupted` ends this process, once a signal has asked for that and all calls are ended: what waits for standard input
    cannot be ended otherwise.
    """
    from mcp.server.stdio import stdio_server

    server = made(service)

    async def listen() -> None:
        with anyio.open_signal_receiver(signal.SIGINT, signal.SIGTERM) as signals:
            async for _ in signals:
                await service.end()
                interrupted()

    async def main() -> None:
        try:
            async with anyio.create_task_group() as tasks:
                tasks.start_soon(listen)
                async with stdio_server() as (read, write):
                    await server.run(read, write, server.create_initialization_options())
                tasks.cancel_scope.cancel()
        except* (BrokenPipeError, anyio.BrokenResourceError, anyio.ClosedResourceError):
            # A client that was killed reads no answer: it is gone as if it had closed the connection.
            await service.end()

    anyio.run(main)
