from plan_cutters.cli import main

main()
