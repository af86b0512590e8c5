UPDATE event SET step = 99999999999, node = -1;
