// sphere
