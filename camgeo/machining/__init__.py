"""What making and measuring a part takes: the cutter's path, programs, inspection, compensation."""
