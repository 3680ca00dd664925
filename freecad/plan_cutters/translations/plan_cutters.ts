<?xml version="1.0" encoding="utf-8"?>
<!DOCTYPE TS>
<TS version="2.1">
 <context>
  <name>PlanCutters</name>
  <message>
   <source>fill in “Stick-out”, which {bits} do not state</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>“Stick-out” is shorter than the flutes of {bit}, {length}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>choose a “Holder”, or “None at all”, which {bits} do not state</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>fill in “Stick-out” and “Holder”, which {bits} do not state</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>and {count} more</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Plan cutters</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Plan cutters…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Say which cutters can finish the selected body or faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Results…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Legend, cutters and worst spots of a plan in this document</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Review page</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Open the plan's review page in a browser</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>CAM job of the operations</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>A job with the tool controllers, and work planes, of a plan that has operations</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Remove results</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Take away what plans show in this document; the bodies are shown again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Settings…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Where the program is, and more</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Free-form faces and fillets</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Picked faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>All faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Any tool axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>3 axes</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>4 axes, A</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>3+2 table, C on A</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Trunnion, C on A</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Trunnion, C on B</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Table C, head B</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Head C, A</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Nutating head B, table C</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Within 30° of the setup axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Within 60° of the setup axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>No</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The fewest</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The fastest</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Both plans</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Part and faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>none: select a body</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Body</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Take</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Take the body, faces, or CAM job selected now</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>To machine</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Pick</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Click faces in the view, more of them with Ctrl</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>click faces in the view; Ctrl adds more</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>none</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Machine and setup</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>A machine that the program knows, tilt:45, or a machine file</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Machine</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>File…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>TOML, JSON, .fcm, .ini, .mch</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{axis} of the document</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Proposed by the program</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Picked face or edge</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The direction of the part that points along the spindle when all rotary axes are at zero</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Click a flat face, a straight edge or an axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Spindle</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Click what holds the part; Ctrl adds more</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Fixtures</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Table under the part</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Stock that is left on the surface on purpose</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Allowance</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>As allowance</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Judge with the stock of the job left on the surface</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Fixed orientations (3+2) that finish together all that is reached</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Operations</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>More options of plan-cutters, as in a terminal</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>More</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Stock of {job}: {length} over the part at least</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Machines</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>All files</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>click a flat face, a straight edge or an axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>nothing is picked yet</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>click what holds the part</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no spindle direction is picked: click a flat face, a straight edge or an axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the fixture {label} lies in another document than the body</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the body that is planned is picked as a fixture, too</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>“More” cannot be read: {error}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program's path cannot be read: {error}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program plan-cutters was not found: install it apart from FreeCAD, for example with `uv tool install` or `pipx install` from its folder, or give its path in the settings or in the environment variable PLAN_CUTTERS</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} has no Face{number}: it has {count} faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the allowance must be 0 mm or more, not {allowance:g}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} is the body itself: it cannot be a fixture, too</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan does not hold the whole shape of {cutter}: ask the program for its posture maps</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{bit} is no tool bit</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the holder of {bit} cannot be read: {why}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>give short words of cutters, or libraries and tool bits, not both</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no plan is shown in this document: plan first</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the review page of this plan is not there any more: plan again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Result</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Cutter</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Legend: share of the area</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Worst spots</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Face</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Why</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>In the way</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Depth</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Depth: how far what is in the way reaches into the tool</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Show the tool there</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Posture map</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>All postures of the cutter at the spot shown, or at the last click</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Whole part</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Fit all in the view</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Open the plan's page in a browser</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Remove</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Take this plan away and show the body again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>selected</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Each face has the colour of its worst verdict with this cutter.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Click a spot: the view flies there. Or click a face: what is known there.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>No sample is lost with this cutter. Click a face: what is known there.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The plan is no longer in the document.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no posture is known here: no tool is shown</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>drawing…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Postures of {cutter} at {face}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Says which cutters can finish the picked faces, before any toolpath exists</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>&amp;Plan cutters</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the selection lies in {count} documents: select in one of them</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>select one body, or faces of one body; selected are {count} objects</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>select faces of one body; selected are faces of {count}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>select faces or the whole body, not edges or points</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} has {count} models: select the one that is machined</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>select the link {label} itself in the tree: its faces belong to another object</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} is a container: select a body in it</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} is a mesh: select a body with CAD faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} is not the last step of {body}: select faces of the body as it is shown</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} holds no faces: select a body</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the document {document} was closed</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{name} is no longer in the document {document}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{thing} has no axis: pick a plane or round face, a straight or round edge</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan is about the document {document}, not {name}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{changed} while it was planned: plan again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan has {count} faces, {label} another number of them</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>without a colour of their own, for they are too small or whole faces are coloured: {names}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} was changed</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{changed} after the plan: plan again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Clear plans</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Plan is out of date</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{why}. The colours of {label} were dropped</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no posture of {cutter} is known at {face}: there is no tool to show</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Tool at a spot</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan does not have the place of the tip of {cutter}: the review page shows it</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Hide tool</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the {plan} plan of operations has no model: it is not shown</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the {plan} plan of operations is not shown: {error}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>this plan shows no operations: choose some in “Operations” and plan again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Job of a plan</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>this FreeCAD made no CAM job: the report view says why</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>step {number}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>there is no step to judge</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{where}: the cutter is missing</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{where}: faces: write F3 F6, or left, not “{faces}”</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{where}: “{text}” is no orientation: write {example}, or simultaneous</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>select the body to machine, or faces of it, and press “Take”</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no face is picked: click faces in the view</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>all faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{count} face</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{count} faces</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>free-form faces and fillets</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label}: {faces}; {tools}; {machine}; spindle {setup}.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>any tool axis</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Plan</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Cancel</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no document is open</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{cutter}: each face has the colour of the worst verdict on it</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>PlanOperations.FCMacro is not beside the add-on: copy the whole folder</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Program</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>plan-cutters is not on the search path</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Path of plan-cutters, or a command with words; empty: as it is found on the search path</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Find…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Command</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The workbench runs the program plan-cutters as a process of its own, with its own Python. Install it once, for example with “uv tool install .” or “pipx install .” in its folder.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The program plan-cutters</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan has no cutter {wanted}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>take {cutter}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>no cutter is selected</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>An older program made this plan, without text ({verdict}; the colours show {shown}): plan again.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{face}, {away} from the click: {verdict}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>for {reason}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>, or </source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{depth} deep</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>(undecided)</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the samples of this plan cannot be read: plan again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program wrote no plan: give options of plan-cutters alone, no files of parts</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program wrote no plan of plan-cutters</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the plan has the format {version}, this workbench reads {known}: update the add-on</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>fill in “Stick-out”</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>choose one in “Holder”, or “None at all”</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{program} cannot be started: {why}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program ended with code {code} and wrote nothing</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the body cannot be written: {why}</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the answer cannot be read ({why})</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>cancelled; nothing was changed</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the program drew no posture map that can be read</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Steps</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Double-click an orientation (C 0 A 90, simultaneous), a cutter or faces (F3 F6, left) to change it</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Up</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>This step before the one above</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Down</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>This step behind the one below</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Leave out</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>The process without this step</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Plan what they leave</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Judge again</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Judge these steps as they stand, in this order</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>There is no step.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{area} are gone if it is left out and nothing is planned there.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Changed: judge again.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>a {shape} cutter is not drawn here: the review page shows it</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>As the tools say</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>None at all</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Collet chuck ER16</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Collet chuck ER32</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>HSK63-A with ER32</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>BT40 with ER32</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Tools</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Tick what is judged. Nothing ticked: the program's own set of usual metric sizes. Del takes away.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Diameter D or radius R, stick-out L, corner radius rc: R6L80rc6 is a ball end. Enter adds it.</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Add</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Tool library…</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Fusion, HSMWorks, FreeCAD or TOML</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Of the tools that have none: a name as er32, R15L30 (radius, length), or a file</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Holder</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>as the tools say</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>From the holder's face to the tip, of library tools that state none</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Stick-out</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{label} (tool bit)</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>Tool libraries</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>short words are judged without tool bits and libraries: untick one or the other</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{count} tool</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>{count} tools</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>the default tool set</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>whether plans are up to date is not known: {error}</source>
   <translation type="unfinished" />
  </message>
 </context>
 <context>
  <name>Workbench</name>
  <message>
   <source>Plan cutters</source>
   <translation type="unfinished" />
  </message>
  <message>
   <source>&amp;Plan cutters</source>
   <translation type="unfinished" />
  </message>
 </context>
</TS>
