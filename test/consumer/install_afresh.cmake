# cmake -DBUILD=... -DPREFIX=... -DCONFIG=... -P install_afresh.cmake: no file of an earlier installation is left.
file(REMOVE_RECURSE "${PREFIX}")
execute_process(COMMAND ${CMAKE_COMMAND} --install "${BUILD}" --config "${CONFIG}" --prefix "${PREFIX}"
                COMMAND_ERROR_IS_FATAL ANY)
