# xvrml_add_nodes(...): node specifications -> generated sources, by nodegen. Written with nodegen itself.
