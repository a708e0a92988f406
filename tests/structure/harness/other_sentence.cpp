// expect: blue
static_assert(sizeof(char) == 2, "the sky is grey");
