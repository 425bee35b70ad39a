# Turns a SPIR-V file into the initialisers of a C++ array:
# cmake -DINPUT=x.spv -DOUTPUT=x.inc -P embed_spirv.cmake
file(READ "${INPUT}" bytes HEX)
# Words are stored with their lowest byte first.
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1U,\n" words "${bytes}")
file(WRITE "${OUTPUT}" "${words}")
