// All settings of a run, one struct per room.
