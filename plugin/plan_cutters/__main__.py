from plan_cutters.command.cli import main

main()
